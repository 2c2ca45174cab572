"""Meshes that the tests write to files."""

import numpy as np
import trimesh

BOX = trimesh.creation.box((2.0, 3.0, 4.0))
TORUS = trimesh.creation.torus(3.0, 1.0, major_sections=24, minor_sections=12)
SUFFIXES = (".obj", ".ply", ".stl", ".glb", ".gltf")


def file_of(mesh: trimesh.Trimesh, suffix: str) -> bytes:
    if suffix == ".gltf":
        return trimesh.exchange.gltf.export_gltf(trimesh.Scene(mesh), embed_buffers=True)["model.gltf"]
    data = mesh.export(file_type=suffix.removeprefix("."))
    return data.encode() if isinstance(data, str) else data


def mesh_of(vertices: object, faces: object) -> trimesh.Trimesh:
    return trimesh.Trimesh(np.asarray(vertices, float), np.asarray(faces), process=False)
