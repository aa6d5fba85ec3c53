#!/usr/bin/env python3
"""Writes small valid files of every kind that is read, the fuzzers' first inputs, to a directory."""
import pathlib
import struct
import sys

out = pathlib.Path(sys.argv[1])
# A tetrahedron.
vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
# Six surflets of an octahedron.
surflets = [tuple(s * (k == axis) for k in range(3)) * 2 for axis in range(3) for s in (1, -1)]


def write(kind, name, content):
    folder = out / kind
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def lines(rows):
    return "".join(" ".join(map(str, row)) + "\n" for row in rows)


def off():
    body = lines(vertices) + lines((3,) + f for f in faces)
    write("off", "plain", "OFF\n4 4 6\n" + body)
    write("off", "stuck", "OFF4 4 6\n# comment\n" + body)
    write("off", "coloured", "COFF 1 0 0\n0 1e-3 -2.5 255 0 0 255\n")
    write("off", "polygon", "OFF\r\n4 1 0\r\n" + lines(vertices) + "4 0 1 2 3 1 0 0\r\n")


def ply_header(form, normals, count, face_type):
    text = f"ply\nformat {form} 1.0\ncomment a tetrahedron\nelement vertex {count}\n"
    for name in ["x", "y", "z"] + ["nx", "ny", "nz"] * normals:
        text += f"property float {name}\n"
    if face_type:
        text += f"element face 4\nproperty list uchar {face_type} vertex_indices\n"
    return text + "end_header\n"


def ply():
    write("ply", "ascii", ply_header("ascii", 0, 4, "int") + lines(vertices)
          + lines((3,) + f for f in faces))
    write("ply", "surflets", ply_header("ascii", 1, 6, "") + lines(surflets))
    for form, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        body = b"".join(struct.pack(order + "3f", *v) for v in vertices)
        body += b"".join(struct.pack(order + "B3i", 3, *f) for f in faces)
        write("ply", form, ply_header(form, 0, 4, "int").encode() + body)


def obj():
    body = lines(("v",) + v for v in vertices) + "vn 0 0 1\nvt 0 0\n"
    write("obj", "plain", "# tetrahedron\n" + body + lines(("f", *(i + 1 for i in f)) for f in faces))
    write("obj", "slashes", body + "o a\ng b\nf 1/1/1 2//1 3/1 4\nf -1 -2 -3\n")


def stl():
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for i in f for c in vertices[i]), 0)
                      for f in faces)
    write("stl", "binary", b"tetrahedron".ljust(80) + struct.pack("<I", 4) + facets)
    text = "solid tetrahedron\n"
    for f in faces:
        text += "facet normal 0 0 1\nouter loop\n" + lines(("vertex", *vertices[i]) for i in f)
        text += "endloop\nendfacet\n"
    write("stl", "ascii", text + "endsolid tetrahedron\n")


def pcd_header(names, count, data, size=4, kind="F"):
    n = len(names)
    return (f"# .PCD v0.7\nVERSION 0.7\nFIELDS {' '.join(names)}\nSIZE {' '.join([str(size)] * n)}\n"
            f"TYPE {' '.join([kind] * n)}\nCOUNT {' '.join(['1'] * n)}\nWIDTH {count}\nHEIGHT 1\n"
            f"VIEWPOINT 0 0 2 1 0 0 0\nPOINTS {count}\nDATA {data}\n")


def lzf(plain):
    """Literal runs only, which every LZF decoder takes."""
    return b"".join(bytes([len(plain[i:i + 32]) - 1]) + plain[i:i + 32]
                    for i in range(0, len(plain), 32))


def pcd():
    names = ["x", "y", "z", "normal_x", "normal_y", "normal_z"]
    body = b"".join(struct.pack("<6f", *s) for s in surflets)
    write("pcd", "ascii", pcd_header(names, 6, "ascii") + lines(surflets))
    write("pcd", "binary", pcd_header(names, 6, "binary").encode() + body)
    by_field = b"".join(struct.pack("<6f", *column) for column in zip(*surflets))
    packed = lzf(by_field)
    write("pcd", "compressed", pcd_header(names, 6, "binary_compressed").encode()
          + struct.pack("<2I", len(packed), len(by_field)) + packed)
    write("pcd", "points", pcd_header(names[:3], 6, "ascii") + lines(s[:3] for s in surflets))
    write("pcd", "doubles", pcd_header(names, 6, "binary", 8).encode()
          + b"".join(struct.pack("<6d", *s) for s in surflets))


def database():
    """Two models of 2 x 2 x 2 x 2 bins, as doc/database_format.md describes them."""
    bins = 16
    fields = [("format_version", "I", 4, "U", 1), ("label", "64s", 1, "U", 64),
              ("condition", "64s", 1, "U", 64), ("role", "I", 4, "U", 1), ("member", "I", 4, "U", 1),
              ("resolution", "4I", 4, "U", 4)]
    fields += [(name, "d", 8, "F", 1) for name in ("delta_max", "r_mean", "r_max", "r_min",
                                                   "surface_area", "features", "tau", "floor")]
    fields += [("histogram", f"{bins}f", 4, "F", bins)]
    head = "# .PCD v0.7\nVERSION 0.7\n"
    for key, column in (("FIELDS", 0), ("SIZE", 2), ("TYPE", 3), ("COUNT", 4)):
        head += key + " " + " ".join(str(f[column]) for f in fields) + "\n"
    head += "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n"
    layout = "<" + "".join(f[1] for f in fields)
    rows = [struct.pack(layout, 1, label, b"", role, 0, 2, 2, 2, 2, 2.0, 0.7, 1.0, 0.5, 3.0, 1000.0,
                        0.001, 1e-6, *([1.0 / bins] * bins))
            for label, role in ((b"ball", 0), (b"table", 1))]
    write("database", "two", head.encode() + b"".join(rows))


def command_line():
    for name, words in (("numbers", ["-count", "7", "-real", "1e-3", "file"]),
                        ("flag", ["-flag", "--", "-not_an_option"]), ("help", ["-h"]),
                        ("sensor", ["-views", "ring", "-sensor_noise", "0.001", "a", "b"]),
                        ("bins", ["-database", "d", "-bins", "5,5,5,5", "-label", "x", "cup.ply"])):
        for program in range(4):
            write("command_line", f"{name}{program}",
                  bytes([program]) + b"\0".join(w.encode() for w in words))


def bank():
    write("bank", "all", "normals 3  # spacings\nnoise 1\nvisible 40 members 6\n\n"
          "noise 4 visible 50 members 3\nview noise 0.3 members 6\n")
    write("bank", "view", "view\r\n")


for kind in (off, ply, obj, stl, pcd, database, bank, command_line):
    kind()
