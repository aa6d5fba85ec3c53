#!/usr/bin/env python3
"""Calls the apps with random options and checks that they end with an exit code of theirs.

usage: app_options.py BIN_DIRECTORY SECONDS [SEED]

The words are those of each app's own help, numbers at the edges of ranges, damaged text and small
files of every kind. A run may take ten seconds of processor time, 3 GiB and 1 MB a file; to be
stopped for that is no finding.
"""
import collections
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile
import time

here = pathlib.Path(__file__).resolve().parent
binaries, seconds = pathlib.Path(sys.argv[1]).resolve(), float(sys.argv[2])
seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
choose = random.Random(seed)
VALUES = ["0", "1", "2", "3", "5", "-1", "1e-30", "1e30", "nan", "inf", "-inf", "0x10", "1e999", "",
          " ", "18446744073709551616", "5,5,5,5", "7,7,7,7", "5,5,5", "0,0,0", "1,2,3:4,5,6",
          "default", "none", "auto", "all", "one", "ring24", "exclude", "model", "explanation",
          "sphere", "cup", "torus", "cone", "\xff\xfe", "a" * 5000, "-", "--", ".", "/", "%s%n"]


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (10, 10))
    resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))


def run(app, arguments, folder):
    try:
        return subprocess.run([app, *(a.encode("utf-8", "surrogateescape") for a in arguments)],
                              cwd=folder, preexec_fn=limit, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return None


def options_of(app, folder):
    text = run(app, ["-h"], folder).stdout.decode()
    return re.findall(r"^  (-\w+)( \S+)?", text, re.M)


def line_for(options, files):
    words = []
    for name, value in choose.sample(options, min(len(options), choose.randrange(6))):
        words.append(name)
        if value and choose.random() < 0.95:
            words.append(choose.choice(VALUES + files))
    words += choose.choices(files + ["missing.pcd"], k=choose.randrange(3))
    if choose.random() < 0.1:
        words.insert(choose.randrange(len(words) + 1), choose.choice(VALUES))
    return words


with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.executable, here / "corpus.py", folder + "/in"], check=True)
    files = []
    for kind, ending in (("off", "off"), ("ply", "ply"), ("obj", "obj"), ("stl", "stl"),
                         ("pcd", "pcd"), ("database", "pcd")):
        for path in sorted(pathlib.Path(folder, "in", kind).iterdir()):
            path = path.rename(path.with_name(f"{path.name}.{ending}"))
            files.append(str(path.relative_to(folder)))
    # The viewer would open windows; what runs too long is stopped.
    apps = [a for a in sorted(binaries.glob("pcl_surflet_*")) if not a.name.endswith("_view")]
    tables = {app: options_of(app, folder) for app in apps}
    results, findings, end = collections.Counter(), 0, time.time() + seconds
    while time.time() < end:
        app = choose.choice(apps)
        words = line_for(tables[app], files)
        done = run(app, words, folder)
        code = "time" if done is None else done.returncode
        results[code] += 1
        stopped = code in ("time", -9, -24, -25)  # killed, CPU, file size
        silent = code in (1, 2) and not done.stderr
        if not stopped and (code not in (0, 1, 2) or silent):
            findings += 1
            print(f"FOUND {app.name} {words}: {code}\n{done.stderr[-2000:].decode(errors='replace')}")
    print(f"app_options: {sum(results.values())} runs of {len(apps)} apps, seed {seed}, exit codes "
          f"{dict(results)}, {findings} findings")
    sys.exit(findings > 0)
