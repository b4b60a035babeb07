"""Arms and hands."""

import numpy as np

from body import Table, angle, tables
from trunk import ANSUR_MEN, ANSUR_WOMEN

FINGERS = ("index", "middle", "ring", "little")
HAND = ("thumb_", "index_", "middle_", "ring_", "little_", "finger_", "palm_")
DUTCH = "hand of the Dutch arm model (Blana et al. 2008) x 193/179"
AAOS = "AAOS handbook, estimates; allowed 10°"
MACEDO = "Macedo & Magee, 90 women; allowed 10°"


def rows(man, woman):
    t = Table("arm, hand")
    lengths(t, man, woman)
    elbow(t, man, woman)
    wrist(t, man)
    hand(t, man)
    thumb(t, man)
    opposition(t, man)
    return t.rows


def lengths(t, man, woman):
    p, q = man.rest, woman.rest
    t.near("stylion height, man", "mm", p.at("radial_styloid_r")[1], 844, 22, ANSUR_MEN)
    t.near("stylion height, woman", "mm", q.at("radial_styloid_r")[1], 789, 20, ANSUR_WOMEN)
    leva = "de Leva 1996, part of stature (recalled); allowed 12"
    t.near("elbow to wrist", "mm", p.distance("elbow_center_r", "wrist_center_r"), 270, 12, leva)
    t.near("shoulder to elbow", "mm", p.distance("shoulder_center_r", "elbow_center_r"), 283, 12, leva)
    for name, body, theirs, sd, source in (
        ("man", man, 1808, 49, ANSUR_MEN),
        ("woman", woman, 1649, 46, ANSUR_WOMEN),
    ):
        level = body.pose(shoulder_elevation_r=90, shoulder_elevation_l=90)
        span = level.at("middle_tip_r")[2] - level.at("middle_tip_l")[2]
        t.near(f"span, arms level to the sides, {name}", "mm", span, theirs, sd, source)
    breadth = p.distance("lateral_epicondyle_humerus_r", "medial_epicondyle_humerus_r")
    t.near(
        "epicondyles, bone and 2 x 2 of skin", "mm", breadth + 4, 71, 5, "elbow breadth (recalled)", used=True
    )


def elbow(t, man, woman):
    def carrying(body):
        p = body.rest
        d = p.at("wrist_center_r") - p.at("elbow_center_r")
        arm = p.axes("humerus_r")[:, 2]
        return np.degrees(np.arcsin(d @ arm / np.linalg.norm(d)))

    source = "Paraskevas et al. 2004, 600 students"
    t.near("carrying angle, man", "°", carrying(man), 11.0, 4.3, source)
    t.near("carrying angle, woman", "°", carrying(woman), 15.1, 5.0, source)
    p = man.rest
    humerus = p.axes("humerus_r")
    hinge = humerus.T @ man.axis("ulna_r", elbow_flex_r=90)
    t.between(
        "elbow axis, off that of another model",
        "°",
        angle(hinge, [0.049, 0.037, 0.998]),
        0,
        10,
        "Saul et al. 2014",
    )
    source = "Rajagopal et al. 2016, whose humerus is turned by 10° about its length"
    t.between(
        "elbow axis, off that of another model", "°", angle(hinge, [0.226, 0.022, 0.974]), 0, 10, source
    )
    forearm = humerus.T @ man.axis("radius_r", pro_sup_r=90)
    source = "Saul et al. 2014 (whose radial head is used)"
    t.between(
        "forearm axis, off that of another model",
        "°",
        angle(forearm, [-0.017, 0.993, -0.120]),
        0,
        10,
        source,
        used=True,
    )
    t.between(
        "forearm axis, off that of another model",
        "°",
        angle(forearm, [0.056, 0.998, 0.002]),
        0,
        10,
        "Rajagopal et al. 2016",
    )
    low, high = man.typical("pro_sup_r")
    source = "PMC2730984, five people, elbow at 90, active"
    t.near("pronation and supination, typical", "°", high - low, 153, 14, source)
    soucie = "Soucie et al. 2011, men of 20 to 44, passive (recalled); allowed 10°"
    t.near("elbow flexion, typical", "°", man.typical("elbow_flex_r")[1], 144.6, 10, soucie)
    t.near("supination from the thumb forward, typical", "°", 90 - low, 85.0, 10, soucie)
    t.near("pronation from the thumb forward, typical", "°", high - 90, 76.9, 10, soucie)
    turns = man.poses([dict(pro_sup_r=a) for a in range(0, 176, 5)])
    apart = np.array([x.distance("radial_styloid_r", "ulnar_styloid_r") for x in turns])
    t.between(
        "styloids apart, half pronated",
        "mm",
        apart[17],
        51,
        66,
        "people (recalled); the ulna's fovea was placed so",
        used=True,
    )
    t.between(
        "styloids, change as the forearm turns",
        "mm",
        np.ptp(apart),
        0,
        8,
        "nearly constant (recalled)",
        used=True,
    )


def wrist(t, man):
    lean = tables("arms.toml")["joint_set"]["wrist_r"]["component"]["reach"]["ellipse"]["tilt"]
    t.near("lean of the ellipse of the wrist", "°", lean, 26.6, 4.4, "Crisco et al. 2011, six cadavers, 2 Nm")
    refused = 0
    for pose in (dict(wrist_flex_r=40), dict(wrist_flex_r=-40), dict(wrist_dev_r=-10), dict(wrist_dev_r=30)):
        r = man.pose(**pose).axes("hand_r").T @ man.pose(limits="on", **pose).axes("hand_r")
        refused = max(refused, np.degrees(np.arccos(np.clip((np.trace(r) - 1) / 2, -1, 1))))
    source = "Ryu et al. 1991 (recalled): 40 of flexion, extension and deviation in all are needed"
    t.between("refused of the functional range of the wrist", "°", refused, 0, 0.1, source)
    back, front = man.typical("wrist_flex_r")
    radial, ulnar = man.typical("wrist_dev_r")
    for name, ours, handbook, women in (
        ("flexion", front, 80, 93),
        ("extension", -back, 70, 86),
        ("radial deviation", -radial, 20, 18),
        ("ulnar deviation", ulnar, 30, 41),
    ):
        t.near(f"wrist, {name}, typical", "°", ours, handbook, 10, AAOS)
        t.near(f"wrist, {name}, typical", "°", ours, women, 10, MACEDO)


def hand(t, man):
    p = man.rest
    inverse = np.linalg.inv(p.segments["hand_r"])
    local = lambda point: (inverse @ [*(point / 1e3), 1])[:3] * 1e3
    head = {f: local(p.point(f"{f}_proximal_r")) for f in FINGERS}
    source = ANSUR_MEN + ", skin crease; ours to the middle of the first bone"
    middle = 0.5 * np.linalg.norm(p.point("middle_middle_r") - p.point("middle_proximal_r"))
    crease = local(p.point("middle_proximal_r", (9, -middle, 0)))
    t.near("palm length", "mm", local(p.at("radial_styloid_r"))[1] - crease[1], 116, 6, source)
    breadth = head["index"][2] - head["little"][2]
    t.near(
        "hand breadth, joints and 15 of bone and 13 of skin", "mm", breadth + 28, 88, 4, ANSUR_MEN, used=True
    )
    # In that model's axes (radial, distal negative, dorsal); the arch was taken from it, so breadth and length only.
    scale = 193 / 179
    dutch = dict(index=(18.2, -65.9), middle=(0.7, -65.5), ring=(-13.9, -64.2), little=(-23.5, -56.1))
    for f in ("index", "ring", "little"):
        theirs = scale * (np.array(dutch[f]) - dutch["middle"])[::-1]
        off = np.linalg.norm((head[f] - head["middle"])[1:] - theirs)
        t.between(f"head of {f} metacarpal from the middle one's, off", "mm", off, 0, 4, DUTCH)
    for f in FINGERS:
        theirs = round(scale * (7.5 - dutch[f][1]), 1)
        t.near(
            f"wrist to the head of the {f} metacarpal, along",
            "mm",
            -head[f][1],
            theirs,
            4,
            DUTCH + ", wrist midway between its rows",
        )
    lengths = dict(index=(42.6, 25.1), middle=(44.7, 29.1), ring=(40.4, 24.9), little=(36.1, 21.0))
    an = dict(index=1.85, middle=1.63, ring=1.57, little=1.76)
    for f in FINGERS:
        joints = [p.point(f"{f}_{bone}_r") for bone in ("proximal", "middle", "distal")]
        first, second = (np.linalg.norm(b - a) for a, b in zip(joints, joints[1:]))
        t.near(f"first bone of the {f} finger", "mm", first, round(scale * lengths[f][0], 1), 4, DUTCH)
        t.near(f"second bone of the {f} finger", "mm", second, round(scale * lengths[f][1], 1), 4, DUTCH)
        t.near(
            f"first to second bone, {f} finger", "", first / second, an[f], 0.15, "An et al. 1979", digits=2
        )
    fist(t, man)


def fist(t, man):
    bent = {f"{f}_mcp_flex_r": 90 for f in FINGERS} | {f"{f}_pip_flex_r": 100 for f in FINGERS}
    p = man.pose(palm_arch_r=15, **bent)
    hand = p.axes("hand_r").T
    tubercle = hand @ p.at("scaphoid_tubercle_r")
    passes = dict(index=9, middle=4.3, ring=1.2, little=-0.1)
    for f in FINGERS:
        a, b = hand @ p.point(f"{f}_middle_r"), hand @ p.point(f"{f}_distal_r")
        u, r = (b - a)[1:], (tubercle - a)[1:]
        miss = (u[1] * r[0] - u[0] * r[1]) / np.linalg.norm(u)
        t.near(
            f"fist, {f} finger past the tubercle of the scaphoid",
            "mm",
            miss,
            passes[f],
            10,
            "30 people, 240 fingers, digital rotation",
            used=True,
        )


def opposition(t, man):
    """Kapandji's score: the thumb's pulp to those of the fingers, then its tip down the little finger."""
    down = {
        "crease of the last joint": ("little_distal_r", (5.5, 0, 0)),
        "crease of the second joint": ("little_middle_r", (7, 0, 0)),
        "crease of the first joint": ("little_proximal_r", (9, -18, 0)),
        "crease of the palm": ("little_metacarpal_r", (21, -51, -15.8)),
    }
    source = "Kapandji 1986, young people do it; the thumb's ranges were tried with it"
    for f in FINGERS:
        p = man.solve("thumb_pulp_r", f'"{f}_pulp_r"', HAND)
        gap = p.distance("thumb_pulp_r", f"{f}_pulp_r")
        t.between(f"opposition, thumb to the pulp of the {f} finger", "mm", gap, 0, 5, source, used=True)
    for name, (segment, point) in down.items():
        at = [x / 1e3 for x in point]
        p = man.solve("thumb_tip_r", f'{{ segment = "{segment}", at = {at} }}', HAND)
        gap = np.linalg.norm(p.at("thumb_tip_r") - p.point(segment, point))
        t.between(f"opposition, thumb to the little finger, {name}", "mm", gap, 0, 5, source, used=True)


def thumb(t, man):
    cooney = "Cooney et al. 1981 (recalled); allowed 12°"
    flexion = np.ptp(man.range("thumb_cmc_flex_r"))
    t.near("thumb, first joint, flexion in all", "°", flexion, 53, 12, cooney)
    t.near("thumb, first joint, abduction in all", "°", np.ptp(man.range("thumb_cmc_abd_r")), 42, 12, cooney)
    low, high = (
        man.pose(thumb_cmc_flex_r=x).axes("thumb_metacarpal_r") for x in man.range("thumb_cmc_flex_r")
    )
    # The part of the turn that is about the metacarpal itself.
    r = low.T @ high
    w = np.sqrt(max(0, 1 + np.trace(r))) / 2
    y = (r[0, 2] - r[2, 0]) / (4 * w)
    twist = abs(np.degrees(2 * np.arctan2(y, w)))
    t.near(
        "thumb, turn about its metacarpal, flexed from end to end",
        "°",
        twist,
        17,
        6,
        "Cooney et al. 1981 (recalled)",
    )
    t.near(
        "thumb, turn about its metacarpal, flexed from end to end",
        "°",
        twist,
        9,
        6,
        "Kawanishi et al. 2018, CT, in opposition",
    )
