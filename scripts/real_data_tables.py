#!/usr/bin/env python3
"""Compares what pcl_surflet_interpret found with the truth, for real_data.sh.

outline MODEL.pcd LABELLED.pcd LABEL   points of the scene where the model's are, against those so
                                       labelled
poses TRUTH.csv MODELS.csv FOUND.csv   names, centres and poses
"""
import csv
import math
import struct
import sys


def lzf(data, size):
    """LZF as PCD files have it."""
    out, at = bytearray(), 0
    while at < len(data):
        control = data[at]
        at += 1
        if control < 32:
            out += data[at : at + control + 1]
            at += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += data[at]
            at += 1
        start = len(out) - ((control & 31) << 8) - data[at] - 1
        at += 1
        for k in range(length + 2):
            out.append(out[start + k])
    if len(out) != size:
        raise ValueError("damaged LZF data")
    return bytes(out)


def read_pcd(path):
    """Columns of a binary or compressed PCD file whose fields are single."""
    with open(path, "rb") as file:
        content = file.read()
    head, at = {}, 0
    while "DATA" not in head:
        end = content.index(b"\n", at)
        words = content[at:end].decode().split()
        at = end + 1
        if words and words[0] != "#":
            head[words[0]] = words[1:]
    n = int(head["POINTS"][0])
    letters = {("F", "4"): "f", ("U", "4"): "I", ("U", "1"): "B", ("F", "8"): "d"}
    kinds = [letters[key] for key in zip(head["TYPE"], head["SIZE"])]
    if head["DATA"][0] == "binary":
        rows = struct.iter_unpack("<" + "".join(kinds), content[at:])
        columns = list(zip(*rows))
    else:
        packed, size = struct.unpack_from("<II", content, at)
        data, columns, at = lzf(content[at + 8 : at + 8 + packed], size), [], 0
        for kind in kinds:
            columns.append(struct.unpack_from(f"<{n}{kind}", data, at))
            at += n * struct.calcsize(kind)
    return dict(zip(head["FIELDS"], columns))


def outline(model_path, scene_path, label):
    near = 5e-4  # of a coordinate: the model's points are the scene's own
    def key(point):
        return tuple(round(c / near) for c in point)
    model, scene = read_pcd(model_path), read_pcd(scene_path)
    places = {key(p) for p in zip(model["x"], model["y"], model["z"])}
    true = right = labelled = 0
    for x, y, z, found in zip(scene["x"], scene["y"], scene["z"], scene["label"]):
        cell = key((x, y, z)) if not math.isnan(x) else None
        is_true = cell in places
        true += is_true
        labelled += found == label
        right += is_true and found == label
    print(f"{true} of {len(places)} places of the model met by the scene's points, "
          f"{labelled} points labelled, {right} of both: "
          f"precision {100 * right / max(1, labelled):.1f} %, recall {100 * right / max(1, true):.1f} %")


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def angle(truth, found):
    """Degrees between a matrix and a quaternion; the other arguments are rows of the tables."""
    x, y, z, w = (float(found[name]) for name in ("qx", "qy", "qz", "qw"))
    r = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    t = [[float(truth[f"m{i}{j}"]) for j in range(3)] for i in range(3)]
    if found["symmetry"] == "continuous":  # the axis is all that can be told
        a = [float(found[f"axis_{c}"]) for c in "xyz"]
        along = sum(sum(r[i][j] * a[j] for j in range(3)) * sum(t[i][j] * a[j] for j in range(3))
                    for i in range(3))
        return math.degrees(math.acos(max(-1, min(1, along))))
    trace = sum(r[i][j] * t[i][j] for i in range(3) for j in range(3))
    return math.degrees(math.acos(max(-1, min(1, (trace - 1) / 2))))


def poses(truth_path, models_path, found_path):
    models = {row["object"]: row for row in table(models_path)}
    found, truth = table(found_path), table(truth_path)
    right = centred = placed = 0
    worst = []
    for item in truth:
        centre = [float(item[c]) for c in ("cx", "cy", "cz")]
        model = models[item["object"]]
        own = [row for row in found if row["label"] == item["object"]]
        if not own:
            worst.append(f"{item['object']}: not found")
            continue
        off = min(math.dist(centre, [float(r[c]) for c in "xyz"]) for r in own)
        right += off < float(model["r_mean"])
        centred += off < float(model["r_mean"]) / 2
        posed = [r for r in own if r["tx"]]
        if not posed:
            continue
        best = min(posed, key=lambda r: angle(item, r))
        shift = math.dist([float(item[f"m{i}3"]) for i in range(3)],
                          [float(best[t]) for t in ("tx", "ty", "tz")])
        turn = angle(item, best)
        placed += shift < 0.01 and turn < 10
        worst.append(f"{item['object']}: {1000 * off:.0f} mm, pose {1000 * shift:.1f} mm "
                     f"{turn:.1f} deg, confidence {float(best['confidence']):.2f}")
    print(f"{found_path}: {len(truth)} there, {len(found)} detections, {right} found, {centred} centred within half "
          f"r_mean, {placed} posed within 10 mm and 10 degrees")
    for line in worst:
        print("   " + line)


if __name__ == "__main__":
    if len(sys.argv) != 5 or sys.argv[1] not in ("outline", "poses"):
        sys.exit(__doc__)
    if sys.argv[1] == "outline":
        outline(sys.argv[2], sys.argv[3], int(sys.argv[4]))
    else:
        poses(*sys.argv[2:])
