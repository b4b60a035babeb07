"""Writes parts.osim: a model of every part whose scaling OpenSim decides on, in one small file.

    python oracles/scale/parts.py > oracles/scale/parts.osim
"""

V = "0.1 0.2 0.3"


def function(kind):
    linear = lambda a, b: f"<LinearFunction><coefficients>{a} {b}</coefficients></LinearFunction>"
    multiplied = lambda inner, s: (
        f"<MultiplierFunction><function>{inner}</function><scale>{s}</scale></MultiplierFunction>"
    )
    return {
        "slope 1": linear(1, 0),
        "slope 1, apart": linear(1, 0.1),
        "slope 1, multiplied": multiplied(linear(1, 0), 1),
        "slope 2": linear(2, 0),
        "slope -1": linear(-1, 0),
        "polynomial": "<PolynomialFunction><coefficients>0.1 0.2 0.05</coefficients></PolynomialFunction>",
        "spline": "<SimmSpline><x>-2 -1 0 1</x><y>0.1 0.2 0.05 0.1</y></SimmSpline>",
        "constant": "<Constant><value>0.3</value></Constant>",
        "twice": multiplied(multiplied(linear(2, 0), 1.5), 2),
        "of two": "<LinearFunction><coefficients>1 1 0</coefficients></LinearFunction>",
    }[kind]


def custom(name, parent, child, kinds):
    axes = ["0.6 0.8 0", "0 0.6 0.8", "0.8 0 -0.6"]
    text, coordinates = "", []
    for i in range(3):
        text += f'<TransformAxis name="rotation{i + 1}"><axis>{" ".join("1" if i == j else "0" for j in range(3))}</axis><function><Constant><value>0.{i + 1}</value></Constant></function></TransformAxis>'
    for i, (kind, axis) in enumerate(zip(kinds, axes)):
        driven = {"constant": [], "of two": [f"{name}_{i}", f"{name}_{i}b"]}.get(kind, [f"{name}_{i}"])
        coordinates += driven
        text += f'<TransformAxis name="translation{i + 1}"><coordinates>{" ".join(driven)}</coordinates><axis>{axis}</axis><function>{function(kind)}</function></TransformAxis>'
    values = "".join(f'<Coordinate name="{c}"><default_value>0.{i + 1}</default_value></Coordinate>' for i, c in enumerate(coordinates))
    return joint("CustomJoint", name, parent, child, values, f"<SpatialTransform>{text}</SpatialTransform>")


def joint(kind, name, parent, child, coordinates="", more=""):
    return f"""<{kind} name="{name}"><socket_parent_frame>p</socket_parent_frame><socket_child_frame>c</socket_child_frame>
<coordinates>{coordinates}</coordinates>
<frames><PhysicalOffsetFrame name="p"><socket_parent>{parent}</socket_parent><translation>{V}</translation><orientation>0.1 0.2 0.3</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="c"><socket_parent>{child}</socket_parent><translation>-0.1 0.05 0.02</translation></PhysicalOffsetFrame></frames>{more}</{kind}>
"""


def body(name, mass=2.0, inertia="0.1 0.12 0.15 0.01 0.02 0.005", more=""):
    return f'<Body name="{name}"><mass>{mass}</mass><mass_center>{V}</mass_center><inertia>{inertia}</inertia>{more}</Body>\n'


turned = "<translation>0.01 0.02 0.03</translation><xyz_body_rotation>0.3 0.4 0.5</xyz_body_rotation>"
wraps = f"""<WrapObjectSet name="wrapobjectset"><objects>
<WrapCylinder name="cylinder"><radius>0.02</radius><length>0.3</length>{turned}</WrapCylinder>
<WrapEllipsoid name="ellipsoid"><dimensions>0.02 0.03 0.04</dimensions>{turned}</WrapEllipsoid>
<WrapSphere name="sphere"><radius>0.02</radius>{turned}</WrapSphere>
<WrapTorus name="torus"><inner_radius>0.02</inner_radius><outer_radius>0.05</outer_radius>{turned}</WrapTorus>
</objects></WrapObjectSet>"""
nested = f"""<components>
<PhysicalOffsetFrame name="turned"><socket_parent>..</socket_parent><translation>{V}</translation><orientation>0.5 0 0</orientation>
<components><PhysicalOffsetFrame name="inner"><socket_parent>..</socket_parent><translation>0.3 0.2 0.1</translation><orientation>0 0.5 0</orientation>
<attached_geometry><Mesh name="mesh"><mesh_file>bone.vtp</mesh_file></Mesh><Sphere name="ball"><radius>0.1</radius><scale_factors>2 1 1</scale_factors></Sphere></attached_geometry>
</PhysicalOffsetFrame></components></PhysicalOffsetFrame>
<Station name="station"><socket_parent_frame>..</socket_parent_frame><location>{V}</location></Station></components>"""

bodies = (
    body("b0")
    + body("b1", more=nested + wraps)
    + body("b2", inertia="0.15 0.1 0.12 0.01 0.02 0.005")
    + body("b3", inertia="0.15 0.15 0.1 0.01 0.02 0.005")
    + body("b4", mass=0)
    + body("b5", mass=1)
    + body("b6", mass=1)
    + body("b7", mass=1)
    + body("b8", mass=1)
)
angles = "".join(f'<Coordinate name="e{i}"><default_value>0.2</default_value></Coordinate>' for i in range(3))
bends = angles.replace('"e', '"c')
wings = "".join(f'<Coordinate name="s{i}"><default_value>0.2</default_value></Coordinate>' for i in range(4))
joints = (
    custom("j0", "/ground", "/bodyset/b0", ["slope 1", "slope 1, apart", "slope 1, multiplied"])
    + custom("j1", "/bodyset/b0", "/bodyset/b1", ["slope 2", "slope -1", "polynomial"])
    + custom("j2", "/bodyset/b1", "/bodyset/b2", ["spline", "constant", "of two"])
    + custom("j3", "/bodyset/b2", "/bodyset/b3", ["twice", "constant", "spline"])
    + joint("WeldJoint", "weld", "/bodyset/b3", "/bodyset/b4")
    + joint("SliderJoint", "slide", "/bodyset/b3", "/bodyset/b5", '<Coordinate name="slid"><default_value>0.2</default_value><range>-0.3 0.4</range></Coordinate>')
    + joint("EllipsoidJoint", "glide", "/bodyset/b3", "/bodyset/b6", angles, "<radii_x_y_z>0.1 0.2 0.3</radii_x_y_z>")
    + joint("ConstantCurvatureJoint", "bend", "/bodyset/b3", "/bodyset/b7", bends, "<length>0.3</length>")
    + joint("ScapulothoracicJoint", "scapula", "/bodyset/b3", "/bodyset/b8", wings,
            "<thoracic_ellipsoid_radii_x_y_z>0.1 0.2 0.3</thoracic_ellipsoid_radii_x_y_z><scapula_winging_axis_origin>0.02 0.03</scapula_winging_axis_origin><scapula_winging_axis_direction>0.4</scapula_winging_axis_direction>")
)
point = lambda n, f, at: f'<PathPoint name="{n}"><socket_parent_frame>{f}</socket_parent_frame><location>{at}</location></PathPoint>'
moving = f"""<MovingPathPoint name="pm"><socket_parent_frame>/bodyset/b2</socket_parent_frame><socket_x_coordinate>/jointset/j2/j2_0</socket_x_coordinate><socket_y_coordinate>/jointset/j2/j2_0</socket_y_coordinate><socket_z_coordinate>/jointset/j2/j2_0</socket_z_coordinate>
<x_location>{function("spline")}</x_location><y_location>{function("constant")}</y_location><z_location>{function("twice")}</z_location></MovingPathPoint>"""
conditional = f'<ConditionalPathPoint name="pc"><socket_parent_frame>/bodyset/b2</socket_parent_frame><location>{V}</location><socket_coordinate>/jointset/j2/j2_0</socket_coordinate><range>-1 1</range></ConditionalPathPoint>'
off = conditional.replace('"pc"', '"po"').replace("-1 1", "5 6").replace("0.1 0.2", "4 5")
path = lambda tag: f"""<{tag} name="path"><PathPointSet><objects>{point("p1", "/bodyset/b0", V)}{point("p2", "/bodyset/b2", "0.1 -0.2 0.3")}{moving}{conditional}{off}
{point("p3", "/bodyset/b1/turned/inner", "0.1 -0.2 0.3")}</objects></PathPointSet></{tag}>"""
of_path = lambda kind, more: f'<{kind} name="{kind.lower()}">{path("GeometryPath")}{more}</{kind}>\n'
fibre = "<optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length>"
forces = (
    of_path("Ligament", "<resting_length>0.5</resting_length>")
    + of_path("Blankevoort1991Ligament", "<slack_length>0.4</slack_length>")
    + of_path("PathSpring", "<resting_length>0.5</resting_length><stiffness>100</stiffness><dissipation>0.1</dissipation>")
    + of_path("PathActuator", "<optimal_force>5</optimal_force>")
    + of_path("Thelen2003Muscle", fibre)
    + of_path("Millard2012EquilibriumMuscle", fibre)
    + of_path("DeGrooteFregly2016Muscle", fibre)
    + of_path("RigidTendonMuscle", fibre)
    + f'<PointToPointSpring name="p2p"><socket_body1>/bodyset/b0</socket_body1><socket_body2>/bodyset/b1</socket_body2><point1>{V}</point1><point2>{V}</point2><stiffness>100</stiffness><rest_length>0.5</rest_length></PointToPointSpring>\n'
    + f'<BushingForce name="bush"><socket_frame1>fa</socket_frame1><socket_frame2>fb</socket_frame2><frames><PhysicalOffsetFrame name="fa"><socket_parent>/bodyset/b0</socket_parent><translation>{V}</translation></PhysicalOffsetFrame><PhysicalOffsetFrame name="fb"><socket_parent>/bodyset/b1</socket_parent><translation>{V}</translation></PhysicalOffsetFrame></frames></BushingForce>\n'
    + f'<PointActuator name="pa"><body>b1</body><point>{V}</point><direction>1 0 0</direction></PointActuator>\n'
    + f'<PointToPointActuator name="ppa"><bodyA>b1</bodyA><bodyB>b2</bodyB><pointA>{V}</pointA><pointB>{V}</pointB></PointToPointActuator>\n'
    + '<CoordinateLimitForce name="limit"><coordinate>slid</coordinate><upper_limit>0.4</upper_limit><lower_limit>-0.3</lower_limit><transition>0.02</transition></CoordinateLimitForce>\n'
    + '<SpringGeneralizedForce name="spring"><coordinate>slid</coordinate><rest_length>0.1</rest_length></SpringGeneralizedForce>\n'
)
contacts = f"""<ContactSphere name="cs"><socket_frame>/bodyset/b1</socket_frame><location>{V}</location><radius>0.03</radius></ContactSphere>
<ContactHalfSpace name="ch"><socket_frame>/bodyset/b1</socket_frame><location>{V}</location></ContactHalfSpace>
<ContactMesh name="cm"><socket_frame>/bodyset/b1</socket_frame><location>{V}</location><filename>none.obj</filename></ContactMesh>"""
contacts = contacts[: contacts.index("<ContactMesh")]
two = lambda kind, name, more: f'<{kind} name="{name}"><isEnforced>false</isEnforced><socket_body_1>/bodyset/b0</socket_body_1><socket_body_2>/bodyset/b3</socket_body_2>{more}</{kind}>\n'
constraints = (
    two("PointConstraint", "point", f"<location_body_1>{V}</location_body_1><location_body_2>{V}</location_body_2>")
    + two("ConstantDistanceConstraint", "distance", f"<location_body_1>{V}</location_body_1><location_body_2>{V}</location_body_2><constant_distance>0.4</constant_distance>")
    + f'<PointOnLineConstraint name="line"><isEnforced>false</isEnforced><socket_line_body>/bodyset/b0</socket_line_body><socket_follower_body>/bodyset/b3</socket_follower_body><line_direction_vec>0 1 0</line_direction_vec><point_on_line>{V}</point_on_line><point_on_follower>{V}</point_on_follower></PointOnLineConstraint>\n'
    + f'<WeldConstraint name="welded"><isEnforced>false</isEnforced><socket_frame1>wa</socket_frame1><socket_frame2>wb</socket_frame2><frames><PhysicalOffsetFrame name="wa"><socket_parent>/bodyset/b0</socket_parent><translation>{V}</translation></PhysicalOffsetFrame><PhysicalOffsetFrame name="wb"><socket_parent>/bodyset/b3</socket_parent><translation>{V}</translation></PhysicalOffsetFrame></frames></WeldConstraint>\n'
)
markers = "".join(
    f'<Marker name="{n}"><socket_parent_frame>{f}</socket_parent_frame><location>{at}</location><fixed>{fixed}</fixed></Marker>\n'
    for n, f, at, fixed in [
        ("m0", "/bodyset/b0", V, "true"), ("m1", "/bodyset/b1/turned/inner", V, "false"), ("m2", "/bodyset/b2", "0 0.1 0", "false"),
        ("g", "/ground", V, "false"),
    ]
)

if __name__ == "__main__":
    print(f"""<?xml version="1.0" encoding="UTF-8" ?>
<!-- Every part whose scaling OpenSim decides on; written by parts.py -->
<OpenSimDocument Version="40000"><Model name="parts">
<BodySet name="bodyset"><objects>
{bodies}</objects></BodySet>
<JointSet name="jointset"><objects>
{joints}</objects></JointSet>
<ConstraintSet name="constraintset"><objects>
{constraints}</objects></ConstraintSet>
<ForceSet name="forceset"><objects>
{forces}</objects></ForceSet>
<MarkerSet name="markerset"><objects>
{markers}</objects></MarkerSet>
<ContactGeometrySet name="contactgeometryset"><objects>
{contacts}</objects></ContactGeometrySet>
</Model></OpenSimDocument>""")
