"""Reads a run's exports with other people's readers and compares every frame with the run's PLY files.

    python read_exports.py RUN [EXPORTS] [--bowknot COMMAND] [--pyvista]

RUN holds scene.toml and frames/*.ply; EXPORTS (default: RUN) the same frames as VTU, PVD, PC2, USD, NPZ and OBJ.
With --bowknot COMMAND it also makes frames of strands and particles, which the command exports, and reads these.
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
            counts = {}
            while (line := file.readline().decode().strip()) != "end_header":
                words = line.split()
                if words[0] == "element":
                    counts[words[1]] = int(words[2])
            kind = np.dtype([("x", "<f8", 3), ("obstacle", "u1"), ("body", "<i4")])
            vertices = np.frombuffer(file.read(kind.itemsize * counts["vertex"]), kind)
            self.x, self.obstacle, self.body = (vertices[name].copy() for name in ("x", "obstacle", "body"))
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
        mesh = meshio.read(folder / f"frames/{k:06}.obj")
        expect(np.array_equal(mesh.points, frame.x), f"frames/{k:06}.obj: points")


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


main()
