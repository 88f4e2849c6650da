"""Reads a run's exports with other people's readers and compares every frame with the run's PLY files.

    python read_exports.py RUN [EXPORTS] [--bowknot COMMAND] [--pyvista]

RUN holds scene.toml and frames/*.ply; EXPORTS (default: RUN) the same frames as VTU, PVD, PC2, USD, NPZ and OBJ.
With --bowknot COMMAND it also makes frames of strands and particles, which the command exports, and a textured OBJ,
which it runs, and reads these.
VTU is read by meshio (with --pyvista by VTK itself), USD by usd-core, PC2 by the struct reader below, written from the
format's notes. Exits with 1 at the first difference.
"""

import argparse
import pathlib
import struct
import subprocess
import sys
import tempfile
import tomllib
import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np

# USD and PC2 hold single precision.
SINGLE = 2.0 ** -23


def expect(condition, message):
    if not condition:
        sys.exit(f"error: {message}")


def close(a, b, what):
    expect(np.shape(a) == np.shape(b), f"{what}: shapes {np.shape(a)} and {np.shape(b)}")
    worst = np.max(np.abs(np.asarray(a) - b), initial=0.0)
    limit = SINGLE * max(1e-30, np.max(np.abs(b), initial=0.0))
    expect(worst <= limit, f"{what}: {worst} apart, {limit} allowed")


class Frame:
    """A PLY frame, by hand: what the others are compared with must not be read by one of them."""

    def __init__(self, path):
        with open(path, "rb") as file:
            counts, names = {}, set()
            while (line := file.readline().decode().strip()) != "end_header":
                words = line.split()
                if words[0] == "element":
                    counts[words[1]] = int(words[2])
                names.add(words[-1])
            texture = [("texture", "<f8", 2)] if {"s", "t"} <= names else []
            kind = np.dtype([("x", "<f8", 3), ("obstacle", "u1"), ("body", "<i4"), *texture])
            vertices = np.frombuffer(file.read(kind.itemsize * counts["vertex"]), kind)
            self.x, self.obstacle, self.body = (vertices[name].copy() for name in ("x", "obstacle", "body"))
            self.texture = vertices["texture"].copy() if texture else None
            self.faces = []
            for _ in range(counts["face"]):
                size = file.read(1)[0]
                self.faces.append(struct.unpack(f"<{size}i", file.read(4 * size)))
            count = counts.get("edge", 0)
            self.edges = np.frombuffer(file.read(8 * count), "<i4").reshape(count, 2)
            used = {v for element in [*self.faces, *self.edges.tolist()] for v in element}
            self.particles = [v for v in range(len(self.x)) if v not in used]


def fans(faces):
    """Quads as two triangles: `bowknot export` reads them so. Lines and vertices stay."""
    return [piece for face in faces
            for piece in ([face] if len(face) < 4 else [(face[0], *face[k:k + 2]) for k in range(1, len(face) - 1)])]


def read_pc2(path):
    """POINTCACHE2, version, points, first frame, sampling rate, samples; then x y z of each."""
    data = path.read_bytes()
    magic, version, points, start, rate, samples = struct.unpack_from("<12siiffi", data)
    expect(magic == b"POINTCACHE2\0" and (version, start, rate) == (1, 0.0, 1.0), f"{path}: header")
    return np.frombuffer(data, "<f4", offset=32).reshape(samples, points, 3)


def check_vtu(folder, frames, dt, use_pyvista):
    sets = ElementTree.parse(folder / "frames.pvd").findall("Collection/DataSet")
    expect(len(sets) == len(frames), f"frames.pvd: {len(sets)} grids for {len(frames)} frames")
    for k, (entry, frame) in enumerate(zip(sets, frames)):
        expect(float(entry.get("timestep")) == k * dt, f"frames.pvd: time of frame {k}")
        path = folder / entry.get("file")
        if use_pyvista:
            import pyvista

            grid = pyvista.read(path)
            points, data = grid.points, grid.point_data
            cells = [tuple(cell.point_ids) for cell in grid.cell]
        else:
            grid = meshio.read(path)
            points, data = grid.points, grid.point_data
            cells = [tuple(cell) for block in grid.cells for cell in block.data.tolist()]
        expect(np.array_equal(points, frame.x), f"{path}: points")
        expect(np.array_equal(np.ravel(data["body"]), frame.body), f"{path}: body")
        expect(np.array_equal(np.ravel(data["obstacle"]), frame.obstacle), f"{path}: obstacle")
        expected = [*fans(frame.faces), *map(tuple, frame.edges.tolist()), *((v,) for v in frame.particles)]
        expect(fans(cells) == expected, f"{path}: cells")


def check_pc2(folder, frames):
    caches = sorted((folder / "pc2").glob("*.pc2"))
    expect(len(caches) == len(set(frames[0].body.tolist())), f"{len(caches)} point caches")
    known = [(cache, read_pc2(cache)) for cache in caches]
    for cache, samples in known:
        expect(len(samples) == len(frames), f"{cache}: {len(samples)} samples")
        # Which body a cache is of, only its first sample tells.
        bodies = [b for b in set(frames[0].body.tolist())
                  if np.array_equal(samples[0], frames[0].x[frames[0].body == b].astype(np.float32))]
        expect(bodies, f"{cache}: of no body")
        for k, frame in enumerate(frames):
            close(samples[k], frame.x[frame.body == bodies[0]], f"{cache}: frame {k}")
        vertices = [line for line in cache.with_suffix(".obj").read_text().splitlines() if line.startswith("v ")]
        expect(len(vertices) == samples.shape[1], f"{cache}: vertices of its OBJ")


def check_usd(folder, frames, dt):
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(str(folder / "scene.usda"))
    expect(UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z, "scene.usda: up axis")
    expect(UsdGeom.GetStageMetersPerUnit(stage) == 1.0, "scene.usda: unit")
    expect(abs(stage.GetTimeCodesPerSecond() * dt - 1.0) < 1e-12, "scene.usda: time codes per second")
    expect((stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, len(frames) - 1), "scene.usda: time codes")
    first = frames[0]
    edges = {tuple(sorted(edge)) for edge in first.edges.tolist()}
    seen = dict(faces=0, edges=0, particles=0)
    for prim in stage.GetDefaultPrim().GetChildren():
        if prim.GetTypeName() == "Scope":
            continue
        geometry = UsdGeom.PointBased(prim)
        times = geometry.GetPointsAttr().GetTimeSamples()
        expect(times == list(range(len(frames))), f"{prim.GetPath()}: time samples")
        # Find the frame's vertices by their places at the start.
        places = {tuple(p): v for v, p in enumerate(first.x.astype(np.float32).tolist())}
        start = np.array(geometry.GetPointsAttr().Get(0))
        vertices = [places.get(tuple(p)) for p in start.tolist()]
        expect(None not in vertices, f"{prim.GetPath()}: points that no vertex of the frame has")
        pad = 0.0
        if prim.IsA(UsdGeom.Mesh):
            mesh = UsdGeom.Mesh(prim)
            counts = list(mesh.GetFaceVertexCountsAttr().Get())
            indices = [vertices[i] for i in mesh.GetFaceVertexIndicesAttr().Get()]
            expect(mesh.GetSubdivisionSchemeAttr().Get() == "none", f"{prim.GetPath()}: subdivision")
            faces = set(fans(first.faces))
            at = 0
            for count in counts:
                for face in fans([tuple(indices[at:at + count])]):
                    expect(face in faces, f"{prim.GetPath()}: face {face}")
                    seen["faces"] += 1
                at += count
        elif prim.IsA(UsdGeom.BasisCurves):
            curves = UsdGeom.BasisCurves(prim)
            expect(curves.GetTypeAttr().Get() == "linear", f"{prim.GetPath()}: type")
            at = 0
            for count in curves.GetCurveVertexCountsAttr().Get():
                chain = vertices[at:at + count]
                at += count
                for edge in zip(chain, chain[1:]):
                    expect(tuple(sorted(edge)) in edges, f"{prim.GetPath()}: edge {edge}")
                seen["edges"] += count - 1
            pad = curves.GetWidthsAttr().Get()[0] / 2
        else:
            expect(prim.IsA(UsdGeom.Points), f"{prim.GetPath()}: {prim.GetTypeName()}")
            widths = UsdGeom.Points(prim).GetWidthsAttr().Get()
            expect(len(widths) == len(vertices) and min(widths) > 0, f"{prim.GetPath()}: widths")
            seen["particles"] += len(vertices)
            pad = widths[0] / 2
        for k, frame in enumerate(frames):
            points = np.array(geometry.GetPointsAttr().Get(k))
            close(points, frame.x[vertices], f"{prim.GetPath()}: frame {k}")
            low, high = np.array(geometry.GetExtentAttr().Get(k))
            expect(np.all(low <= points.min(0) - 0.999 * pad) and np.all(high >= points.max(0) + 0.999 * pad),
                   f"{prim.GetPath()}: extent at frame {k}")
    expected = dict(faces=len(fans(first.faces)), edges=len(edges), particles=len(first.particles))
    expect(seen == expected, f"scene.usda has {seen}, the frame {expected}")


def check_npz(folder, frames):
    with np.load(folder / "frames.npz") as archive:
        expect(np.array_equal(archive["X"], [frame.x for frame in frames]), "frames.npz: X")
        expect(np.array_equal(archive["O"], frames[0].obstacle != 0), "frames.npz: O")
        expect(len(archive["F"]) == sum(len(face) - 2 for face in frames[0].faces), "frames.npz: F")
        expect(np.array_equal(archive["P"], frames[0].particles), "frames.npz: P")


def check_obj(folder, frames):
    for k, frame in enumerate(frames):
        path = folder / f"frames/{k:06}.obj"
        lines = path.read_text().splitlines()
        if any(line.startswith("vt ") for line in lines):
            # meshio takes texture coordinates for those of vertices and refuses another number of them.
            points = [list(map(float, line.split()[1:])) for line in lines if line.startswith("v ")]
        else:
            points = meshio.read(path).points
        expect(np.array_equal(points, frame.x), f"{path}: points")


def write_mixed(folder):
    """Three frames of a branching strand, a loop, a lone edge, particles and a triangle, in three bodies."""
    edges = [(0, 1), (1, 2), (1, 3), (3, 4), (5, 6), (6, 7), (7, 5), (9, 8)]
    body = [0] * 10 + [1] * 4 + [2] * 3
    (folder / "frames").mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text("[simulation]\ndt = 0.02\n")
    places = np.random.default_rng(1).random((len(body), 3))
    for k in range(3):
        header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(body)}\nproperty double x\n"
                  "property double y\nproperty double z\nproperty uchar obstacle\nproperty int body\n"
                  "element face 1\nproperty list uchar int vertex_indices\n"
                  f"element edge {len(edges)}\nproperty int vertex1\nproperty int vertex2\nend_header\n")
        data = header.encode()
        for place, b in zip(places + [0.1 * k, 0.0, -0.2 * k], body):
            data += struct.pack("<3dBi", *place, b == 2, b)
        data += struct.pack("<B3i", 3, 14, 15, 16)
        data += b"".join(struct.pack("<2i", *edge) for edge in edges)
        (folder / f"frames/{k:06}.ply").write_bytes(data)


# Two quads, a triangle and a hexagon: faces as lines of an OBJ, with the labels that hold for each.
GARMENT = """mtllib cloth.mtl
o Garment
v 0 0 1\nv 1 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 0 1 1\nv 3 0.5 1\nv 0 2 1\nv 1 3 1\nv 2 2 1
vt 0 0\nvt 0.4 0\nvt 0.4 0.4\nvt 0 0.4\nvt 0.6 0\nvt 1 0\nvt 1 0.4\nvt 0.6 0.4\nvn 0 0 1\nvn 0 1 0
g left all\nusemtl silk\nf 1/1/1 2/2/1 5/3/1 6/4/1
g right all\nusemtl wool #2\nf 2/5/1 3/6/1 4/7/1 5/8/1\nf 3/6/2 7/7/2 4/8/2
g back\nf 9/1/1 8/2/1 6/3/1 5/4/1 4/5/1 10/6/1
"""


def read_textured_obj(path):
    """Of each face its vertices and texture coordinates; the faces of each group and material."""
    texture, faces, members, current = [], [], {}, {}
    for line in path.read_text().splitlines():
        word, _, rest = line.partition(" ")
        if word == "vt":
            texture.append(tuple(map(float, rest.split())))
        elif word == "usemtl":
            current["materialBind"] = [rest]
        elif word == "g":
            current["group"] = rest.split()
        elif word == "f":
            corners = [(corner.split("/") + ["", ""])[:2] for corner in rest.split()]
            for family, names in current.items():
                for name in names:
                    members.setdefault((family, name), []).append(len(faces))
            faces.append(([int(v) - 1 for v, _ in corners], [texture[int(t) - 1] for _, t in corners if t]))
    return faces, members


def check_attributes(run, original, frames):
    """Polygons, texture coordinates, normals and names of the only textured body, in USD, OBJ and PLY."""
    from pxr import Usd, UsdGeom, UsdShade

    faces, members = read_textured_obj(original)
    written, _ = read_textured_obj(run / "frames/000001.obj")
    expect(written[:len(faces)] == faces, "frames/000001.obj: faces and texture coordinates")
    expect([list(face) for face in frames[0].faces[:len(faces)]] == [face for face, _ in faces], "PLY: polygons")
    expect(frames[0].texture is None, "PLY: texture coordinates, though vertices have two")

    stage = Usd.Stage.Open(str(run / "scene.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/body"))
    counts, indices = mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get()
    points = mesh.GetPointsAttr().Get(0)
    expect(mesh.ValidateTopology(indices, counts, len(points))[0], "scene.usda: topology")
    expect(list(counts) == [len(face) for face, _ in faces], "scene.usda: polygons")
    expect(list(indices) == [v for face, _ in faces for v in face], "scene.usda: vertices of polygons")
    st = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    expect((st.GetTypeName(), st.GetInterpolation()) == ("texCoord2f[]", "faceVarying"), "scene.usda: type of st")
    close(np.array(st.ComputeFlattened()), np.array([c for _, own in faces for c in own]), "scene.usda: st")
    expect(mesh.GetNormalsInterpolation() == "faceVarying", "scene.usda: interpolation of normals")
    for k in range(len(frames)):
        normals = np.array(mesh.GetNormalsAttr().Get(k))
        expect(len(normals) == len(indices), f"scene.usda: number of normals at frame {k}")
        lengths = np.linalg.norm(normals, axis=1)
        expect(np.allclose(lengths, 1.0, atol=1e-6), f"scene.usda: lengths of normals at frame {k}")
    for family, kind in [("materialBind", "nonOverlapping"), ("group", "unrestricted")]:
        expect(UsdGeom.Subset.GetFamilyType(mesh, family) == kind, f"scene.usda: type of family {family}")
        expect(UsdGeom.Subset.ValidateFamily(mesh, "face", family)[0], f"scene.usda: family {family}")
    found = {}
    for subset in UsdGeom.Subset.GetGeomSubsets(mesh):
        prim, family = subset.GetPrim(), subset.GetFamilyNameAttr().Get()
        name = prim.GetMetadata("displayName") or prim.GetName()
        if family == "object":
            continue
        found[family, name] = list(subset.GetIndicesAttr().Get())
        material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
        if family == "materialBind":
            bound = material.GetPrim()
            expect((bound.GetMetadata("displayName") or bound.GetName()) == name, f"scene.usda: material {name}")
    expect(found == members, f"scene.usda has subsets {found}, the OBJ {members}")
    print(f"{run}: polygons, texture coordinates, normals, groups and materials read back from OBJ, PLY and USD")


def run_textured(command, folder):
    folder.mkdir()
    (folder / "garment.obj").write_text(GARMENT)
    run = folder / "run"
    formats = ["--format", "ply,obj,npz,pc2,usd,vtu", "--frames", "2", "--quiet"]
    subprocess.run([command, "run", folder / "garment.obj", "--out", run, *formats], check=True)
    read_all(run, run, False)
    check_attributes(run, folder / "garment.obj", [Frame(path) for path in sorted((run / "frames").glob("*.ply"))])


def read_all(run, exports, use_pyvista):
    frames = [Frame(path) for path in sorted((run / "frames").glob("*.ply"))]
    expect(len(frames) > 1, f"{run}: fewer than two PLY frames")
    expect(np.any(frames[0].x != frames[-1].x), f"{run}: nothing moves")
    dt = tomllib.loads((run / "scene.toml").read_text())["simulation"]["dt"]
    check_vtu(exports, frames, dt, use_pyvista)
    check_pc2(exports, frames)
    check_usd(exports, frames, dt)
    check_npz(exports, frames)
    check_obj(exports, frames)
    print(f"{exports}: {len(frames)} frames of {len(frames[0].x)} vertices read back from VTU, PC2, USD, NPZ and OBJ")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("exports", type=pathlib.Path, nargs="?")
    parser.add_argument("--bowknot", type=pathlib.Path, help="the command, to export strands and particles with")
    parser.add_argument("--pyvista", action="store_true", help="read VTU with VTK instead of meshio")
    options = parser.parse_args()
    read_all(options.run, options.exports or options.run, options.pyvista)
    if options.bowknot:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_mixed(folder)
            formats = ["--format", "obj,npz,pc2,usd,vtu", "--dt", "0.02"]
            subprocess.run([options.bowknot, "export", folder, *formats], check=True)
            read_all(folder, folder, options.pyvista)
            run_textured(options.bowknot.absolute(), folder / "textured")


main()
