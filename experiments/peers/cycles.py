# cycles.py - render a scene of spheres, boxes, planes and meshes with Blender's Cycles on one thread, as random paths.
#   cuvette params SCENE --json >scene.json
#   blender -b --factory-startup --python-exit-code 1 --python experiments/peers/cycles.py -- \
#       scene.json OUT samples=16,64 seeds=1,2 depth=4 width=64 height=48 meshes=FOLDER
# Writes OUT-SAMPLES-SEED.pfm and prints a line "cycles SAMPLES SEED CPU_SECONDS" for each film, with the scene and its
# hierarchy in memory (persistent data) and without the time that a film of a single sample takes.
# FOLDER/NAME.obj is the mesh NAME (cuvette mesh -f obj). Not taken over: highlights, textures, absorption, nested
# media.
# A sphere that is clear with index 1 hollows a larger one: then the larger one has its radius.
# A sphere light is a disc that faces the lit point in Blender 3.4, whose light is fainter by r^2 / (d^2 + r^2).
import array
import json
import math
import os
import sys
import time

import bpy

scene_file, out, *settings = sys.argv[sys.argv.index("--") + 1 :]
settings = dict(one.split("=") for one in settings)
values = {p["path"]: p["value"] for p in json.load(open(scene_file))["params"]}
width, height = int(settings["width"]), int(settings["height"])


def to_blender(v):
    """Cuvette has y up and z away, left-handed; Blender z up, right-handed."""
    return (v[0], v[2], v[1])


def rotation(degrees):
    (sx, cx), (sy, cy), (sz, cz) = ((math.sin(math.radians(a)), math.cos(math.radians(a))) for a in degrees)
    return (
        (cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx),
        (sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx),
        (-sy, cy * sx, cy * cx),
    )


def surface(solid):
    m = bpy.data.materials.new(solid)
    m.use_nodes = True
    nodes, links = m.node_tree.nodes, m.node_tree.links
    nodes.clear()

    def node(kind, **inputs):
        n = nodes.new(kind)
        for name, value in inputs.items():
            n.inputs[name].default_value = value
        return n

    def color(scale):
        return (*(scale * c for c in values[solid + ".color"]), 1)

    def value(name):
        return values[solid + "." + name]

    if value("transparency") == 1:
        shader = node("ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0, IOR=value("ior"))
        shader.distribution = "SHARP"
    elif value("emission") > 0:
        shader = node("ShaderNodeEmission", Color=color(1), Strength=value("emission"))
    else:
        shader = node("ShaderNodeBsdfDiffuse", Color=color(value("diffuse")))
        if value("reflectivity") > 0:
            mirror = node("ShaderNodeBsdfGlossy", Color=(*[value("reflectivity")] * 3, 1), Roughness=0)
            mirror.distribution = "SHARP"
            both = nodes.new("ShaderNodeAddShader")
            links.new(shader.outputs[0], both.inputs[0])
            links.new(mirror.outputs[0], both.inputs[1])
            shader = both
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return m


def add(solid, vertices, faces, smooth, crease_deg=180):
    """Faces are counter-clockwise from outside in a right-handed system; exchanging two axes reverses them."""
    turn, at = rotation(values[solid + ".rotation"]), values[solid + ".position"]
    scale = values.get(solid + ".scale", (1, 1, 1))
    placed = []
    for v in vertices:
        v = [v[i] * scale[i] for i in range(3)]
        placed.append(to_blender([sum(turn[i][k] * v[k] for k in range(3)) + at[i] for i in range(3)]))
    mesh = bpy.data.meshes.new(solid)
    mesh.from_pydata(placed, [], [face[::-1] for face in faces])
    mesh.materials.append(surface(solid))
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(faces))
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(crease_deg)
    mesh.update()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(solid, mesh))


def ball(radius):
    n, m = 256, 128
    vertices = [
        (radius * math.sin(b) * math.cos(a), radius * math.cos(b), radius * math.sin(b) * math.sin(a))
        for b in (math.pi * j / m for j in range(1, m))
        for a in (2 * math.pi * i / n for i in range(n))
    ] + [(0, radius, 0), (0, -radius, 0)]
    top, bottom = len(vertices) - 2, len(vertices) - 1
    faces = [
        (j * n + i, j * n + (i + 1) % n, (j + 1) * n + (i + 1) % n, (j + 1) * n + i)
        for j in range(m - 2)
        for i in range(n)
    ]
    faces += [(top, (i + 1) % n, i) for i in range(n)]
    faces += [(bottom, (m - 2) * n + i, (m - 2) * n + (i + 1) % n) for i in range(n)]
    return vertices, faces


def box(size):
    corners = [(x * size[0] / 2, y * size[1] / 2, z * size[2] / 2) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def plane():
    """Cells that grow with the distance: single precision places hits badly on one cell of that size."""
    steps = [-3000, -200, -20, -3, 3, 20, 200, 3000]
    n = len(steps)
    faces = [
        (k * n + i, (k + 1) * n + i, (k + 1) * n + i + 1, k * n + i + 1) for k in range(n - 1) for i in range(n - 1)
    ]
    return [(x, 0, z) for z in steps for x in steps], faces


def obj(name):
    """The file is right-handed."""
    vertices, faces = [], []
    for line in open(os.path.join(settings["meshes"], name + ".obj")):
        word = line.split()
        if word and word[0] == "v":
            x, y, z = map(float, word[1:4])
            vertices.append([x, y, -z])
        elif word and word[0] == "f":
            faces.append([int(corner.split("/")[0]) - 1 for corner in word[:0:-1]])
    return vertices, faces


def build():
    solids = [path[: -len(".visible")] for path in values if path.endswith(".visible")]
    hollows = [s for s in solids if values[s + ".transparency"] == 1 and values[s + ".ior"] == 1]
    for solid in solids:
        if solid in hollows:
            continue
        if solid + ".mesh" in values:
            name = values[solid + ".mesh"]
            smooth = values[solid + ".shading"] == "smooth" and values[name + ".generate"] != "box"
            add(solid, *obj(name), smooth, values[name + ".crease_deg"])
        elif solid + ".size" in values:
            add(solid, *box(values[solid + ".size"]), False)
        elif solid + ".radius" in values:
            inner = [values[h + ".radius"] for h in hollows if h + ".radius" in values]
            holds = inner and values[solid + ".radius"] > inner[0]
            add(solid, *ball(inner[0] if holds else values[solid + ".radius"]), True)
        else:
            add(solid, *plane(), False)


def light():
    """Radiance of a sphere of power P: P / (4 pi^2 r^2); ours is intensity (reach / r)^2."""
    for name in (path[: -len(".half_angle_deg")] for path in values if path.endswith(".half_angle_deg")):
        lamp = bpy.data.lights.new(name, "POINT")
        reach = values[name + ".reach"]
        lamp.shadow_soft_size, lamp.color = values[name + ".radius"], values[name + ".color"]
        lamp.energy = 4 * math.pi**2 * values[name + ".intensity"] * (reach**2 if reach > 0 else 1)
        if reach == 0:
            lamp.use_nodes = True
            nodes = lamp.node_tree.nodes
            falloff = nodes.new("ShaderNodeLightFalloff")
            falloff.inputs["Strength"].default_value = 1
            lamp.node_tree.links.new(falloff.outputs["Constant"], nodes["Emission"].inputs["Strength"])
        at = bpy.data.objects.new(name, lamp)
        at.location = to_blender(values[name + ".position"])
        bpy.context.scene.collection.objects.link(at)


def look():
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle_y, data.clip_end = "VERTICAL", math.radians(values["camera.fov_deg"]), 1e5
    data.clip_start = 1e-3
    camera = bpy.data.objects.new("camera", data)
    place, target = to_blender(values["camera.position"]), to_blender(values["camera.target"])
    x, y, z = (target[i] - place[i] for i in range(3))
    camera.location = place
    camera.rotation_euler = (math.pi / 2 + math.atan2(z, math.hypot(x, y)), 0, -math.atan2(x, y))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def sky():
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    color = nodes["Background"].inputs["Color"]
    color.default_value = (*values["background.color"], 1)
    world.cycles.sampling_method = "NONE"
    if values["background.kind"] == "gradient":
        ray, parts = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeSeparateXYZ")
        mix = nodes.new("ShaderNodeMixRGB")
        mix.use_clamp = False
        mix.inputs[1].default_value = (*values["background.horizon"], 1)
        mix.inputs[2].default_value = (*values["background.color"], 1)
        links.new(ray.outputs["Generated"], parts.inputs[0])
        links.new(parts.outputs["Z"], mix.inputs[0])
        links.new(mix.outputs[0], color)


def set_up():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.use_persistent_data = True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Standard"
    c = scene.cycles
    c.device, c.use_denoising, c.use_adaptive_sampling, c.pixel_filter_type = "CPU", False, False, "BOX"
    depth = int(settings["depth"])
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = depth
    c.transparent_max_bounces = 0
    c.caustics_reflective = c.caustics_refractive = True
    c.blur_glossy = c.sample_clamp_direct = c.sample_clamp_indirect = c.light_sampling_threshold = 0


def render(count, seed):
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed = count, seed
    scene.render.filepath = "%s-%d-%d.exr" % (out, count, seed)
    start = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - start


def write_pfm(count, seed):
    name = "%s-%d-%d" % (out, count, seed)
    image = bpy.data.images.load(name + ".exr")
    pixels = array.array("f", image.pixels[:])
    bpy.data.images.remove(image)
    os.remove(name + ".exr")
    with open(name + ".pfm", "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height))
        array.array("f", (x for k, x in enumerate(pixels) if k % 4 < 3)).tofile(file)


bpy.ops.wm.read_factory_settings(use_empty=True)
build()
light()
look()
sky()
set_up()
render(1, 1)
start_up = min(render(1, 1) for _ in range(3))
for samples in map(int, settings["samples"].split(",")):
    for film in map(int, settings["seeds"].split(",")):
        spent = (render(samples, film) - start_up) * samples / max(samples - 1, 1)
        write_pfm(samples, film)
        print("\ncycles %d %d %.4f" % (samples, film, spent))
