"""Where OpenSim 4.6 has the meshes that a model names, in its default pose: python meshes.py

For a file of version 4 and one of version 3, as OpenSim's own reader converts it, from the corners of each mesh to the
ground, row by row: the frame of the mesh times its scale factors. Writes new.osim, old.osim and meshes.json beside itself.
"""
import json
import os
import opensim

HERE = os.path.dirname(os.path.abspath(__file__))

NEW = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000"><Model name="new">
<BodySet name="bodyset"><objects>
<Body name="upper"><attached_geometry>
<Mesh name="plain"><socket_frame>..</socket_frame><scale_factors>1 1 1</scale_factors><mesh_file>plain.vtp</mesh_file></Mesh>
<Mesh name="stretched"><socket_frame>..</socket_frame><scale_factors>1.5 0.5 2</scale_factors><mesh_file>stretched.stl</mesh_file></Mesh>
</attached_geometry><mass>1</mass><inertia>1 1 1 0 0 0</inertia>
<components><PhysicalOffsetFrame name="plate">
<attached_geometry><Mesh name="turned"><socket_frame>..</socket_frame><scale_factors>2 1 1</scale_factors><mesh_file>turned.obj</mesh_file></Mesh></attached_geometry>
<socket_parent>..</socket_parent><translation>0.1 -0.2 0.05</translation><orientation>0.3 -0.4 0.5</orientation>
</PhysicalOffsetFrame></components></Body>
<Body name="lower"><attached_geometry>
<Mesh name="far"><socket_frame>..</socket_frame><scale_factors>1 1.25 1</scale_factors><mesh_file>bones/far.vtp</mesh_file></Mesh>
</attached_geometry><mass>1</mass><inertia>1 1 1 0 0 0</inertia></Body>
</objects></BodySet>
<JointSet name="jointset"><objects>
<PinJoint name="shoulder"><socket_parent_frame>shoulder_in</socket_parent_frame><socket_child_frame>/bodyset/upper</socket_child_frame>
<coordinates><Coordinate name="lift"><default_value>0.5</default_value><range>-3 3</range></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="shoulder_in"><socket_parent>/ground</socket_parent><translation>0.25 1.5 -0.125</translation><orientation>0.25 0.5 0.75</orientation></PhysicalOffsetFrame></frames></PinJoint>
<PinJoint name="elbow"><socket_parent_frame>elbow_in</socket_parent_frame><socket_child_frame>/bodyset/lower</socket_child_frame>
<coordinates><Coordinate name="bend"><default_value>-0.75</default_value><range>-3 3</range></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="elbow_in"><socket_parent>/bodyset/upper</socket_parent><translation>0 -0.5 0</translation><orientation>0 0 0</orientation></PhysicalOffsetFrame></frames></PinJoint>
</objects></JointSet>
</Model></OpenSimDocument>
"""

SHOWN = """<DisplayGeometry name=""><geometry_file>%s</geometry_file><transform> %s</transform><scale_factors> %s</scale_factors><display_preference>4</display_preference></DisplayGeometry>"""

OLD = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="30000"><Model name="old"><BodySet name=""><objects>
<Body name="ground"><mass>0</mass></Body>
<Body name="upper"><mass>1</mass><mass_center> 0 0 0</mass_center><inertia_xx>1</inertia_xx><inertia_yy>1</inertia_yy><inertia_zz>1</inertia_zz>
<Joint><PinJoint name="shoulder"><parent_body>ground</parent_body><location_in_parent>0.25 1.5 -0.125</location_in_parent><orientation_in_parent>0.25 0.5 0.75</orientation_in_parent><location>0 0 0</location><orientation>0 0 0</orientation>
<CoordinateSet name=""><objects><Coordinate name="lift"><default_value>0.5</default_value><range>-3 3</range></Coordinate></objects></CoordinateSet></PinJoint></Joint>
<VisibleObject name=""><GeometrySet name=""><objects>
""" + SHOWN % ("plain.vtp", "0 0 0 0 0 0", "1 1 1") + """
""" + SHOWN % ("turned.vtp", "0.3 -0.4 0.5 0.1 -0.2 0.05", "2 1 1") + """
</objects></GeometrySet><scale_factors> 1.5 0.5 2</scale_factors><transform> 0 0 0 0 0 0</transform></VisibleObject></Body>
<Body name="lower"><mass>1</mass><mass_center> 0 0 0</mass_center><inertia_xx>1</inertia_xx><inertia_yy>1</inertia_yy><inertia_zz>1</inertia_zz>
<Joint><PinJoint name="elbow"><parent_body>upper</parent_body><location_in_parent>0 -0.5 0</location_in_parent><orientation_in_parent>0 0 0</orientation_in_parent><location>0 0 0</location><orientation>0 0 0</orientation>
<CoordinateSet name=""><objects><Coordinate name="bend"><default_value>-0.75</default_value><range>-3 3</range></Coordinate></objects></CoordinateSet></PinJoint></Joint>
<VisibleObject name=""><GeometrySet name=""><objects>
""" + SHOWN % ("both.vtp", "0.1 0.2 -0.3 0.01 0.02 0.03", "1 3 1") + """
</objects></GeometrySet><scale_factors> 1 1 1</scale_factors><transform> -0.2 0.6 0.4 0.1 0 -0.1</transform></VisibleObject></Body>
</objects></BodySet></Model></OpenSimDocument>
"""


def places(path):
    model = opensim.Model(path)
    state = model.initSystem()
    found = {}
    for component in model.getComponentsList():
        mesh = opensim.Mesh.safeDownCast(component)
        if mesh is None:
            continue
        frame, factors = mesh.getFrame().getTransformInGround(state), mesh.get_scale_factors()
        turn, place = frame.R(), frame.p()
        rows = [[turn.get(i, j) * factors.get(j) for j in range(3)] + [place.get(i)] for i in range(3)]
        found[mesh.getGeometryFilename()] = sum(rows, [])
    return found


answers = {}
for name, text in (("new", NEW), ("old", OLD)):
    path = os.path.join(HERE, name + ".osim")
    with open(path, "w") as file:
        file.write(text)
    answers[name] = places(path)
with open(os.path.join(HERE, "meshes.json"), "w") as file:
    json.dump(answers, file, indent=1)
    file.write("\n")
