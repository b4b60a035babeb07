"""Pelvis, legs and feet."""

import numpy as np

from body import Table
from trunk import ANSUR_MEN, ANSUR_WOMEN

SCANS = "msk-STAPLE, bones of four people"
ROAAS = "Roaas & Andersson 1982, 210 joints of men of 30 to 40 (recalled), SD"
LENHART = "Lenhart et al. 2015, passive sweep of their model"
RAJAGOPAL = "Rajagopal et al. 2016, its middle taken 22 above and 10 before its origin"


def rows(man, woman):
    t = Table("leg, foot")
    hip(t, man)
    heights(t, man, woman)
    foot(t, man)
    knee(t, man)
    ranges(t, man)
    return t.rows


def hip(t, man):
    at = man.rest.at
    middle = (at("asis_r") + at("asis_l")) / 2
    back = (at("psis_r") + at("psis_l")) / 2
    # Axes of the plane of the iliac spines; 10 mm of skin before them.
    x = (middle - back) / np.linalg.norm(middle - back)
    y = np.array([-x[1], x[0], 0])
    d = at("hip_center_r") - (middle - 10 * x)
    ours = np.array([d @ x, d @ y, d[2]])
    leg = np.linalg.norm(at("asis_r") - at("medial_malleolus_r"))
    width, depth = np.linalg.norm(at("asis_r") - at("asis_l")), np.linalg.norm(middle - back) - 20
    harrington = (-0.24 * depth - 9.9, -0.16 * width - 0.04 * leg - 7.1, 0.28 * depth + 0.16 * width + 7.9)
    hara = (11 - 0.063 * leg, -9 - 0.078 * leg, 8 + 0.086 * leg)
    for name, theirs in (
        ("Harrington et al. 2007, 32 people (n recalled)", harrington),
        ("Hara et al. 2016, 157 people (n recalled)", hara),
    ):
        for axis, a, b in zip(("forward", "up", "to the side"), ours, theirs):
            t.near(
                f"hip from between the iliac spines, {axis}",
                "mm",
                a,
                round(b, 1),
                12,
                name + ", regression; allowed 12",
            )


def heights(t, man, woman):
    m, w = man.rest.at, woman.rest.at
    t.near("mid-patella height, man", "mm", m("patella_center_r")[1], 486, 16, ANSUR_MEN)
    t.near("mid-patella height, woman", "mm", w("patella_center_r")[1], 445, 14, ANSUR_WOMEN)
    t.near("tibiale height, man", "mm", m("tibiale_r")[1], 466, 14, ANSUR_MEN, used=True)
    t.near("tibiale height, woman", "mm", w("tibiale_r")[1], 434, 13, ANSUR_WOMEN)
    for name, body, theirs, source in (("man", m, 841, ANSUR_MEN), ("woman", w, 775, ANSUR_WOMEN)):
        above = theirs - body("ischial_tuberosity_r")[1]
        t.between(
            f"crotch above the lowest bone of the ischium, {name}",
            "mm",
            above,
            0,
            30,
            source + "; it lies between the bones (recalled)",
        )
    t.near(
        "hip breadth over the trochanters, man", "mm", 2 * m("greater_trochanter_r")[2], 345, 22, ANSUR_MEN
    )
    t.near(
        "hip breadth over the trochanters, woman",
        "mm",
        2 * w("greater_trochanter_r")[2],
        352,
        23,
        ANSUR_WOMEN,
    )
    t.near("trochanterion height, woman", "mm", w("greater_trochanter_r")[1], 839, 24, ANSUR_WOMEN, used=True)
    t.near("iliac crest height, woman", "mm", w("iliac_crest_r")[1], 988, 22, ANSUR_WOMEN, used=True)
    t.near(
        "lateral malleolus height, woman", "mm", w("lateral_malleolus_r")[1], 63, 5, ANSUR_WOMEN, used=True
    )
    t.near("foot length, woman", "mm", w("toe_tip_r")[0] - w("heel_r")[0], 245, 9, ANSUR_WOMEN, used=True)
    p = man.rest
    thigh, shank = p.distance("hip_center_r", "knee_center_r"), p.distance("knee_center_r", "ankle_center_r")
    t.near("thigh to shank", "", thigh / shank, 1.006, 0.03, SCANS, used=True, digits=3)


def foot(t, man):
    at = man.rest.at
    a = man.axis("talus_r", ankle_angle_r=10)
    a *= np.sign(a[2])
    out = np.degrees(np.arctan2(-a[0], a[2]))
    t.near("ankle axis turned out against the knee's", "°", out, 32.8, 10, SCANS + ": 39, 34, 31, 27")
    t.near(
        "ankle axis turned out",
        "°",
        out,
        17.3,
        8,
        "malleoli of four recorded people: 21, 6, 25, 17",
        used=True,
    )
    t.near("ankle axis, lateral end up", "°", np.degrees(np.arcsin(a[1])), 0.5, 10, SCANS + ": -9, 2, 2, 7")
    a = man.axis("calcaneus_r", subtalar_angle_r=10)
    a *= np.sign(a[0])
    t.near("subtalar axis up", "°", np.degrees(np.arcsin(a[1])), 31.5, 10, SCANS + ": 41, 31, 31, 23")
    t.near(
        "subtalar axis to the medial side",
        "°",
        np.degrees(np.arctan2(-a[2], a[0])),
        12,
        10,
        SCANS + ": 4, 16, 8, 20",
    )
    t.near("ankle centre height", "mm", at("ankle_center_r")[1], 70.5, 6, SCANS + ": 66 to 75", used=True)
    lower = at("medial_malleolus_r")[1] - at("lateral_malleolus_r")[1]
    source = "static trials of OpenCap 24, gait10dof 17, sprint 10, gait walk 9"
    t.near("lateral malleolus below the medial one", "mm", lower, 15, 9, source, used=True)
    ahead = at("ankle_center_r")[0] - at("heel_r")[0]
    t.near("ankle before the heel", "mm", ahead, 64, 6, "three static trials", used=True)
    fifth = (at("metatarsal_head_5_r")[0] - at("heel_r")[0]) / (at("toe_tip_r")[0] - at("heel_r")[0])
    t.near(
        "fifth metatarsal head, part of the foot's length",
        "",
        fifth,
        0.63,
        0.03,
        "lateral ball of the foot (recalled)",
        digits=3,
    )
    t.near(
        "sole under the ball and under the heel",
        "mm",
        at("sole_ball_r")[1] - at("sole_heel_r")[1],
        0,
        2,
        "definition",
        used=True,
    )
    tuberosity = at("tibial_tuberosity_r") - at("knee_center_r")
    source = "markers of gait walk and sprint 67, 56 less 10; OpenCap 38"
    t.near("tibial tuberosity before the knee", "mm", tuberosity[0], 45, 12, source)
    source = "markers of gait walk 65, OpenCap 81, sprint 89"
    t.near("tibial tuberosity below the knee", "mm", -tuberosity[1], 78, 18, source)
    fibula = at("knee_center_r")[1] - at("fibular_head_r")[1]
    t.near("fibular head below the knee", "mm", fibula, 55, 25, "marker of gait walk, one person")


def knee(t, man):
    angles = [0, 20, 30, 45, 60, 90, 110, 120, 150]
    poses = dict(zip(angles, man.poses([dict(knee_angle_r=a) for a in angles])))
    centre = man.rest.point("tibia_r")
    femur = man.rest.axes("femur_r")
    # Flexion of the patella, and its place from the centre of the knee.
    lenhart = {
        0: (8.8, 53.1, 8.0),
        20: (16, 49.9, -8.3),
        30: (24.2, 45.4, -15.6),
        45: (37.5, 37.0, -23.1),
        60: (50.2, 27.8, -27.7),
        90: (77.1, 9.7, -28.2),
        110: (88.9, -0.9, -27.2),
    }
    rajagopal = {45: (25.6, -38.3, -0.4962), 90: (-8.8, -34.9, -1.2638), 120: (-22.7, -18.7, -1.7863)}
    walker = {30: 8.63, 60: 13.18, 90: 14.88, 120: 14.99}
    for a, p in poses.items():
        place = (femur.T @ (p.point("patella_r") - centre))[:2]
        bone = femur.T @ p.axes("patella_r")
        tibia = femur.T @ p.axes("tibia_r")
        inward = np.degrees(np.arctan2(-tibia[2, 0], tibia[2, 2]))
        if a in lenhart and a:
            flexion, x, y = lenhart[a]
            source = LENHART + " (one end of the band from which ours was taken)"
            t.near(
                f"patella, flexion with the knee at {a}",
                "°",
                np.degrees(np.arctan2(bone[0, 1], bone[1, 1])),
                round(flexion - 8.8, 1),
                6,
                source,
                used=True,
            )
            t.between(
                f"patella, off its place with the knee at {a}",
                "mm",
                np.hypot(*(place - [x, y])),
                0,
                6,
                LENHART,
            )
        if a in rajagopal:
            x, y, turn = rajagopal[a]
            c, s = np.cos(turn), np.sin(turn)
            theirs = np.array([x + 10 * c - 22 * s, y + 10 * s + 22 * c])
            t.between(
                f"patella, off its place with the knee at {a}",
                "mm",
                np.hypot(*(place - theirs)),
                0,
                10,
                RAJAGOPAL,
            )
        if a in walker:
            source = "Walker et al. 1988 as in Rajagopal et al. 2016"
            t.near(f"tibia turned inward with the knee at {a}", "°", inward, walker[a], 4, source)
        if a == 150:
            hamai = "Hamai et al. 2013, lunge"
            t.near("tibia turned inward with the knee at 150", "°", inward, 30, 8, hamai, used=True)
            t.near(
                "valgus with the knee at 150",
                "°",
                -np.degrees(np.arcsin(tibia[2, 1])),
                5,
                4,
                hamai,
                used=True,
            )
    length = [p.distance("patella_apex_r", "patellar_tendon_end_r") for p in poses.values()]
    t.near(
        "patellar tendon to the height of the patella (44)",
        "",
        length[0] / 44,
        1.0,
        0.2,
        "Insall & Salvati, about 1, 0.8 to 1.2 (recalled)",
        digits=2,
    )
    t.between("patellar tendon, change of its length", "mm", np.ptp(length), 0, 1, "definition", used=True)


def ranges(t, man):
    typical = man.typical
    rows = (
        ("hip flexion", typical("hip_flexion_r")[1], 120, 8.3),
        ("hip extension", -typical("hip_flexion_r")[0], 9.5, 5.3),
        ("hip abduction", -typical("hip_adduction_r")[0], 39, 7.0),
        ("hip adduction", typical("hip_adduction_r")[1], 31, 7.3),
        ("hip internal rotation", typical("hip_rotation_r")[1], 33, 8.2),
        ("hip external rotation", -typical("hip_rotation_r")[0], 34, 6.8),
        ("knee flexion", typical("knee_angle_r")[1], 144, 6.5),
        ("ankle dorsiflexion", typical("ankle_angle_r")[1], 15.3, 5.8),
        ("ankle plantarflexion", -typical("ankle_angle_r")[0], 39.6, 7.5),
        ("inversion", typical("subtalar_angle_r")[1], 27.7, 6.9),
        ("eversion", -typical("subtalar_angle_r")[0], 27.8, 6.9),
    )
    for name, ours, theirs, sd in rows:
        t.near(f"{name}, typical", "°", ours, theirs, sd, ROAAS)
    sums = np.ptp(typical("hip_rotation_r"))
    t.near(
        "hip rotation in all, typical",
        "°",
        sums,
        78.5,
        13,
        "Kouyoumdjian et al. 2012, 120 adults; SD of another study",
    )
    t.near(
        "hip extension, typical",
        "°",
        -typical("hip_flexion_r")[0],
        17,
        6,
        "KoreaMed 2006, Thomas test by CT, 21 people",
    )
    t.near(
        "toes, extension, typical",
        "°",
        -typical("mtp_angle_r")[0],
        77.5,
        12.5,
        "65 to 90, passive (recalled)",
    )
