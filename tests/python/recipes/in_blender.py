"""What blender_itself.py runs inside Blender: a ball that is half in a block, both turned and placed, is coloured."""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE), str(HERE.parents[2] / "src/python")]  # Blender does not read PYTHONPATH

import bpy  # noqa: E402  after its path is known
import mathutils  # noqa: E402

from support import ball, block, motion, np, recipe  # noqa: E402

REACH = 2.0


def thing(name, vertices, faces, matrix):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    made.matrix_world = mathutils.Matrix(matrix.tolist())
    return made


def select(active, *others):
    bpy.ops.object.select_all(action="DESELECT")
    for each in (active, *others):
        each.select_set(True)
    bpy.context.view_layer.objects.active = active
    bpy.context.view_layer.update()


def refused(reach=REACH):
    """What the operator says where it cannot."""
    try:
        bpy.ops.object.ist_colour_by_distance(reach=reach)
    except RuntimeError as error:
        return str(error)
    raise AssertionError("the operator took it")


def main():
    add_on = recipe("blender/ist_distance_colours.py")
    add_on.register()
    place = motion((1, 2, 3), 40, (1, -2, 3))
    target = thing("block", *block(), place @ np.diag([2.0, 2.0, 2.0, 1.0]))
    painted = thing("ball", *ball(14.6), place)

    select(target, painted)
    for _ in range(2):  # a second time replaces what the first one left
        assert bpy.ops.object.ist_colour_by_distance(reach=REACH) == {"FINISHED"}
    mesh = painted.data
    count = len(mesh.vertices)
    signed, rgba = np.empty(count, np.float32), np.empty(4 * count, np.float32)
    mesh.attributes["Signed"].data.foreach_get("value", signed)
    mesh.color_attributes["Distance"].data.foreach_get("color", rgba)
    heights = ball(14.6)[0][:, 2] - 10
    expected = np.where(heights <= REACH, heights, np.nan)
    np.testing.assert_allclose(signed, np.where(np.isnan(expected), REACH, expected), atol=1e-4)
    np.testing.assert_allclose(rgba.reshape(-1, 4), add_on.colours(expected, REACH), atol=1e-4)
    assert len(mesh.color_attributes) == 1 and mesh.color_attributes.active_color.name == "Distance"
    assert "Distance" not in target.data.color_attributes

    select(painted)
    assert "select the meshes to colour" in refused()
    empty = thing("points", block()[0], np.empty((0, 3), int), place)
    select(empty, painted)
    assert "no faces" in refused()
    add_on.unregister()
    print(f"in_blender: all held, Blender {bpy.app.version_string}", flush=True)


main()
