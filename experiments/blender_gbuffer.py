"""Writes a frame of a Blender scene as ssrlab reads it (docs/how-to/export_frames.md). Run by Blender 3.4 or later, with Cycles:

    blender -b --factory-startup -P experiments/blender_gbuffer.py -- model.glb frame.exr
    blender -b my.blend -P experiments/blender_gbuffer.py -- frame.exr

frame.exr has depth, normals and materials at the pixels' centres; frame.exr.toml says what they mean. frame_lit.exr is the picture
without reflections, frame_reference.exr the path-traced picture with them.
"""
import argparse
import math
import os
import sys

import bpy
import numpy

AOVS = {"roughness": "VALUE", "metallic": "VALUE", "base_colour": "COLOR"}


def arguments():
    parser = argparse.ArgumentParser(prog="blender_gbuffer.py")
    parser.add_argument("files", nargs="+", help="[MODEL.glb] FRAME.exr")
    parser.add_argument("--size", default="", help="WIDTHxHEIGHT; default: the scene's")
    parser.add_argument("--samples", type=int, default=64, help="of frame_lit.exr and frame_reference.exr")
    parser.add_argument("--frame", type=int, help="of the animation; default: the current one")
    chosen = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    if len(chosen.files) > 2 or not chosen.files[-1].endswith(".exr"):
        parser.error("expected [MODEL.glb] FRAME.exr")
    return chosen


def refuse(text):
    sys.exit(f"blender_gbuffer.py: {text}")


def load_model(path):
    if not hasattr(numpy, "bool"):  # Debian 12: the glTF importer of Blender 3.4 uses a name that NumPy 1.24 removed
        numpy.bool = bool
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(path))


def complete(scene):
    """What a model may lack: a camera is an error, light is not."""
    if scene.camera is None:
        cameras = [item for item in scene.objects if item.type == "CAMERA"]
        if not cameras:
            refuse("the scene has no camera")
        scene.camera = cameras[0]
    if scene.world is None:
        scene.world = bpy.data.worlds.new("grey")
        scene.world.color = (0.25, 0.25, 0.25)
    if not any(item.type == "LIGHT" for item in scene.objects):
        sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
        sun.data.energy = 3
        sun.rotation_euler = (0.7, 0.2, 0.4)
        scene.collection.objects.link(sun)


def write_material_aovs(material):
    """Sends what the surface's shader gets to the passes of AOVS."""
    if not material.use_nodes:
        return
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shaders = [node for node in nodes if node.type == "BSDF_PRINCIPLED"]
    if not shaders:
        print(f"blender_gbuffer.py: material '{material.name}' has no Principled BSDF: it counts as black and smooth")
        return
    for name, socket in (("roughness", "Roughness"), ("metallic", "Metallic"), ("base_colour", "Base Color")):
        output = nodes.new("ShaderNodeOutputAOV")
        output.name = name
        source = shaders[0].inputs[socket]
        target = output.inputs["Color" if AOVS[name] == "COLOR" else "Value"]
        if source.is_linked:
            links.new(source.links[0].from_socket, target)
        else:
            target.default_value = source.default_value


def prepare_passes(scene, layer):
    layer.use_pass_z = True
    layer.use_pass_normal = True
    layer.use_pass_emit = True
    for name, kind in AOVS.items():
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
    for material in bpy.data.materials:
        write_material_aovs(material)


def refuse_what_no_frame_can_say(scene):
    """A frame's camera is a pinhole with square pixels and axes at right angles."""
    render, camera = scene.render, scene.camera
    if render.pixel_aspect_x != render.pixel_aspect_y:
        refuse(f"the pixels are not square ({render.pixel_aspect_x:g} x {render.pixel_aspect_y:g}): set Output, Format, Aspect to 1 x 1")
    if camera.data.type not in ("PERSP", "ORTHO"):
        refuse(f"camera '{camera.name}' is of type {camera.data.type}: only perspective and orthographic cameras have a depth buffer")
    axes = camera.matrix_world.to_3x3().normalized().col
    if max(abs(axes[0].dot(axes[1])), abs(axes[1].dot(axes[2])), abs(axes[2].dot(axes[0]))) > 1e-4:
        refuse(f"the axes of camera '{camera.name}' are not at right angles: a parent scales it unevenly; clear the parent or apply its scale")


def turn_off_what_moves_points(scene, layer):
    """Each pixel is to show one point through its centre, once."""
    if scene.camera.data.dof.use_dof:
        print("blender_gbuffer.py: depth of field is off in all pictures")
        scene.camera.data.dof.use_dof = False
    scene.render.use_motion_blur = False
    scene.render.use_multiview = False
    scene.render.use_compositing = False
    scene.render.use_sequencer = False
    layer.cycles.denoising_store_passes = False  # a second depth and normal
    for other in scene.view_layers:
        other.use = other == layer


def render(scene, path, samples, multilayer):
    """One sample: at the pixels' centres, so that depth and normals belong to each other."""
    data = samples == 1
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX" if data else "BLACKMAN_HARRIS"
    scene.cycles.filter_width = 0.01 if data else 1.5
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR"
    settings.color_mode = "RGBA" if multilayer else "RGB"
    settings.color_depth = "32"
    settings.exr_codec = "ZIP"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def camera_text(scene, size):
    camera = scene.camera
    width, height = size
    projection = camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=width, y=height)
    axes = camera.matrix_world.to_3x3().normalized()
    right, up, back = axes.col
    vector = lambda v: f"[{v[0]:.9g}, {v[1]:.9g}, {v[2]:.9g}]"
    lines = [f"near_m  = {camera.data.clip_start:.9g}", f"right   = {vector(right)}", f"up      = {vector(up)}",
             f"forward = {vector(-back)}", f"position = {vector(camera.matrix_world.translation)}"]
    if camera.data.type == "ORTHO":
        lines += ['projection = "orthographic"', f"height_m = {2 / projection[1][1]:.9g}", f"far_m = {camera.data.clip_end:.9g}",
                  f"shift_x_px = {projection[0][3] * width / 2:.9g}", f"shift_y_px = {-projection[1][3] * height / 2:.9g}"]
    else:
        lines += [f"fov_y_deg = {math.degrees(2 * math.atan(1 / projection[1][1])):.12g}",
                  f"shift_x_px = {-projection[0][2] * width / 2:.9g}", f"shift_y_px = {projection[1][2] * height / 2:.9g}"]
    return "[camera]\n" + "\n".join(lines) + "\n"


def main():
    chosen = arguments()
    if len(chosen.files) == 2:
        load_model(chosen.files[0])
    scene = bpy.context.scene
    if chosen.frame is not None:
        scene.frame_set(chosen.frame)
    complete(scene)
    refuse_what_no_frame_can_say(scene)
    turn_off_what_moves_points(scene, bpy.context.view_layer)
    if chosen.size:
        scene.render.resolution_x, scene.render.resolution_y = (int(side) for side in chosen.size.split("x"))
        scene.render.resolution_percentage = 100
    scale = scene.render.resolution_percentage / 100
    size = int(scene.render.resolution_x * scale), int(scene.render.resolution_y * scale)
    scene.render.engine = "CYCLES"
    scene.render.use_border = False
    scene.render.film_transparent = False
    prepare_passes(scene, bpy.context.view_layer)

    output = os.path.abspath(chosen.files[-1])
    stem = output[:-len(".exr")]
    render(scene, output, 1, True)
    render(scene, stem + "_reference.exr", chosen.samples, False)
    # Without reflections of surfaces; light sources still shine in them.
    scene.cycles.glossy_bounces = 0
    render(scene, stem + "_lit.exr", chosen.samples, False)

    name = os.path.basename(stem)
    with open(output + ".toml", "w", encoding="utf-8") as file:
        file.write(f'reference = "{name}_reference.exr"\n\n{camera_text(scene, size)}\n')
        file.write('[depth]\nkind = "distance"\n\n[normals]\nspace = "world"\n\n[channels]\n')
        file.writelines(f'"lit.{c}" = "{name}_lit.exr:{c}"\n' for c in "RGB")


if __name__ == "__main__":
    main()
