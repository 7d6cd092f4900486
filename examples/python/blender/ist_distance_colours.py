"""An add-on of Blender: colours the vertices of the selected meshes by their distances from the active one.

Install the package where Blender's Python finds it: Debian's Blender uses the system's python3-ist; any other one its own
Python, PYTHON -m pip install ist-VERSION-py3-none-PLATFORM.whl. Then Edit > Preferences > Add-ons > Install, this file.

Select the meshes to colour, then the one to measure from (the active one), and choose Object > Colour by Distance.
Meshes are measured where they stand in the scene, scaled as they are, without modifiers. Each gets the attributes
"Signed" (a distance in units of the scene, negative inside, the reach where it is farther) and "Distance" (its colour).
"""

import numpy as np

try:
    import ist
except ImportError as missing:
    raise ImportError("the package ist is missing: install its wheel with Blender's Python") from missing
try:
    import bpy
except ImportError:  # outside Blender all that stands before its classes works alone
    bpy = None

bl_info = {
    "name": "Colour by Distance (IST)",
    "description": "Colours meshes by their distances from another one",
    "author": "The authors of IST",
    "version": (1, 0),
    "blender": (3, 2, 0),
    "location": "Object > Colour by Distance",
    "category": "Object",
}

INSIDE, SURFACE, FAR, BEYOND = np.array([(0.7, 0.05, 0.1, 1), (1, 0.95, 0.7, 1), (0.1, 0.25, 0.7, 1), (0.6, 0.6, 0.58, 1)])


def placed(vertices, faces, matrix):
    """Vertices (n, 3) and faces (m, 3) by a matrix, which may scale. One that mirrors turns the faces round, so that
    their outer side stays outside."""
    matrix = np.asarray(matrix, float)
    moved = np.asarray(vertices, float) @ matrix[:3, :3].T + matrix[:3, 3]
    return moved, faces[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else faces


def distances(points, vertices, faces, reach):
    """The signed distance of each point from a surface; NaN beyond the reach."""
    if len(faces) == 0:
        raise ValueError("the active mesh has no faces: choose one with a surface")
    tree = ist.build((vertices, faces))
    return ist.signed_distance(tree, points, reach=reach)["distance"]


def colours(signed, reach):
    """Colours (n, 4): red inside, pale where the surfaces meet, blue as far away as the reach, grey beyond."""
    part = np.clip(signed / reach, -1, 1)[:, None]
    mixed = np.where(part < 0, SURFACE + (SURFACE - INSIDE) * part, SURFACE + (FAR - SURFACE) * part)
    return np.where(np.isnan(signed)[:, None], BEYOND, mixed)


if bpy is not None:

    def content(thing):
        """The vertices and triangles of an object, in units of the scene."""
        mesh = thing.data
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        faces = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.vertices.foreach_get("co", vertices)
        mesh.loop_triangles.foreach_get("vertices", faces)
        return placed(vertices.reshape(-1, 3), faces.reshape(-1, 3), thing.matrix_world)

    def attribute(attributes, name, kind):
        """A new attribute of points, in the place of one of that name."""
        if name in attributes:
            attributes.remove(attributes[name])
        return attributes.new(name, kind, "POINT")

    class IST_OT_colour_by_distance(bpy.types.Operator):
        bl_idname = "object.ist_colour_by_distance"
        bl_label = "Colour by Distance"
        bl_description = "Colours the selected meshes by their distances from the active one"
        bl_options = {"REGISTER", "UNDO"}
        reach: bpy.props.FloatProperty(name="Reach", default=2.0, min=1e-6, description="Farther vertices turn grey; units of the scene")

        def execute(self, context):
            active = context.active_object
            chosen = [each for each in context.selected_objects if each.type == "MESH" and each is not active]
            if active is None or active.type != "MESH" or not chosen:
                self.report({"ERROR"}, "select the meshes to colour, then the mesh to measure from")
                return {"CANCELLED"}
            try:
                surface = content(active)
                for each in chosen:
                    self.colour(each.data, distances(content(each)[0], *surface, self.reach))
            except (ValueError, ist.Error) as wrong:
                self.report({"ERROR"}, str(wrong))
                return {"CANCELLED"}
            return {"FINISHED"}

        def colour(self, mesh, signed):
            known = np.where(np.isnan(signed), self.reach, signed).astype(np.float32)
            attribute(mesh.attributes, "Signed", "FLOAT").data.foreach_set("value", known)
            painted = attribute(mesh.color_attributes, "Distance", "FLOAT_COLOR")
            painted.data.foreach_set("color", colours(signed, self.reach).astype(np.float32).ravel())
            mesh.color_attributes.active_color = painted
            mesh.update()

    def entry(menu, _):
        menu.layout.operator(IST_OT_colour_by_distance.bl_idname)

    def register():
        bpy.utils.register_class(IST_OT_colour_by_distance)
        bpy.types.VIEW3D_MT_object.append(entry)

    def unregister():
        bpy.types.VIEW3D_MT_object.remove(entry)
        bpy.utils.unregister_class(IST_OT_colour_by_distance)
