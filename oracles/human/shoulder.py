"""Shoulder girdle. Angles of clavicle and scapula in the thorax are those of Ludewig et al. 2009, Y-X'-Z''."""

import numpy as np

from body import Table, angles_yxz
from trunk import ANSUR_MEN, ANSUR_WOMEN

LUDEWIG = "Ludewig et al. 2009, bone pins, 12 people"
MOBL = "Saul et al. 2014, regression after de Groot & Brand 2001"
PEETERS = "Peeters et al. 2023, 14 shoulders of whole cadavers"


def rows(man, woman):
    t = Table("shoulder")
    places(t, man, woman)
    rhythm(t, man)
    ranges(t, man)
    return t.rows


def places(t, man, woman):
    p, q = man.rest, woman.rest
    t.near("acromion height, man", "mm", p.at("acromion_r")[1], 1435, 19, ANSUR_MEN, used=True)
    t.near("acromion height, woman", "mm", q.at("acromion_r")[1], 1326, 16, ANSUR_WOMEN)
    source = ", skin; ours is bone and 2 x 7 of skin"
    t.near(
        "biacromial breadth, man",
        "mm",
        2 * p.at("acromion_r")[2] + 14,
        415,
        15,
        ANSUR_MEN + source,
        used=True,
    )
    t.near("biacromial breadth, woman", "mm", 2 * q.at("acromion_r")[2] + 14, 365, 15, ANSUR_WOMEN + source)
    clavicle = p.distance("sternoclavicular_r", "acromioclavicular_r")
    t.near(
        "clavicle, joint to joint", "mm", clavicle, 149.4, 10.3, "Bernat et al., 68 clavicles, whole length"
    )
    border = "Sobush et al. 1996 and others, means (recalled)"
    t.between("trigonum to the midline, man", "mm", p.at("trigonum_r")[2], 55, 70, border)
    t.between("trigonum to the midline, woman", "mm", q.at("trigonum_r")[2], 55, 70, border)
    apart = "Sci Rep 2021, 81879, women"
    t.near("between the inferior angles, man", "mm", 2 * p.at("inferior_angle_r")[2], 164, 22, apart)
    t.near("between the inferior angles, woman", "mm", 2 * q.at("inferior_angle_r")[2], 164, 22, apart)

    def level(height):
        """The thoracic spinous process as high, by number, straight between the tips."""
        tips = [p.at(f"spinous_process_t{k}")[1] for k in range(1, 13)]
        return np.interp(-height, -np.array(tips), range(1, 13))

    t.near(
        "inferior angle, level of thoracic spine",
        "",
        level(p.at("inferior_angle_r")[1]),
        8,
        1,
        "PMC2647093, 34 radiographs, standing",
    )
    t.near(
        "superior angle, level of thoracic spine", "", level(p.at("superior_angle_r")[1]), 2, 1, "textbooks"
    )
    t.between(
        "trigonum, level of thoracic spine", "", level(p.at("trigonum_r")[1]), 2.5, 4.5, "textbooks: T3 to T4"
    )
    schroeder = "von Schroeder et al. 2001, 15 pairs"
    height = p.distance("superior_angle_r", "inferior_angle_r")
    t.near("superior to inferior angle", "mm", height, 155, 16, schroeder, used=True)
    spine = p.distance("trigonum_r", "acromion_r")
    t.near("spine, medial edge to lateral edge of the acromion", "mm", spine, 134, 12, schroeder)
    processes = p.distance("acromion_r", "coracoid_process_r")
    t.near(
        "acromion to coracoid process",
        "mm",
        processes,
        31.1,
        8,
        "Siriraj Med J 2004, 97 scapulae; allowed 2 SD",
    )


def rhythm(t, man):
    heights = [30, 120, 155]
    planes = {"frontal": 0, "scapular": 40, "sagittal": 90}
    poses = [
        dict(shoulder_plane_r=plane, shoulder_elevation_r=e) for plane in planes.values() for e in heights
    ]

    def read(pose):
        thorax = pose.axes("thorax").T
        back, up, roll = angles_yxz(thorax @ pose.axes("clavicle_r")) * [-1, -1, 1]
        internal, upward, tilt = angles_yxz(thorax @ pose.axes("scapula_r")) * [1, -1, 1]
        return dict(back=back, up=up, roll=roll, internal=internal, upward=upward, tilt=tilt)

    read_all = [read(pose) for pose in man.poses(poses)]
    at = {(name, e): read_all[3 * i + j] for i, name in enumerate(planes) for j, e in enumerate(heights)}

    def change(name, plane="scapular"):
        return at[plane, 120][name] - at[plane, 30][name]

    upward = change("upward")
    ratio = (90 - upward) / upward
    t.near(
        "humerus to scapula, 30 to 120 of elevation", "", ratio, 2, 0.4, "Inman et al. 1944, 2 : 1", digits=2
    )
    source = "Braman et al. 2009, bone pins, raising"
    t.near("humerus to scapula, 30 to 120 of elevation", "", ratio, 2.3, 0.4, source, used=True, digits=2)
    up = at["scapular", 155]
    source = ", at 150 to 160 of elevation (recalled)"
    t.between(
        "upward rotation of the scapula at 155", "°", up["upward"], 45, 60, "50 to 55" + source + ", ± 5"
    )
    t.between("elevation of the clavicle at 155", "°", up["up"], 15, 30, "20 to 25" + source + ", ± 5")
    source = "Shao & Ng-Thow-Hing 2003, lower bound of a figure"
    t.near("clavicle up, 30 to 120 of abduction", "°", change("up", "frontal"), 13.2, 5, source)
    ludewig = {
        "upward": ("scapula upward", 8, dict(frontal=30.8, scapular=28.0, sagittal=28.2)),
        "tilt": ("scapula tilts back", 6, dict(frontal=14.0, scapular=13.9, sagittal=15.8)),
        "back": ("clavicle back", 6, dict(frontal=12.7, scapular=11.7, sagittal=11.3)),
        "up": ("clavicle up", 6, dict(frontal=5.2, scapular=5.4, sagittal=4.4)),
        "roll": ("clavicle turns back", 6, dict(frontal=21.7, scapular=22.4, sagittal=25.0)),
    }
    for name, (words, allowed, values) in ludewig.items():
        for plane, theirs in values.items():
            t.near(
                f"{words}, 30 to 120, {plane} plane",
                "°",
                change(name, plane),
                theirs,
                allowed,
                LUDEWIG,
                used=True,
            )
    # Degrees per 150 of elevation in that model, 0.6 of them.
    mobl = {"upward": 35.6, "tilt": 16.0, "internal": -4.4, "back": 21.8, "up": 9.2}
    words = dict(
        upward="scapula upward",
        tilt="scapula tilts back",
        internal="scapula inward",
        back="clavicle back",
        up="clavicle up",
    )
    for name, theirs in mobl.items():
        t.near(f"{words[name]}, 30 to 120, scapular plane", "°", change(name), theirs, 8, MOBL, used=True)
    rest, shrug = read(man.rest), read(man.pose(shrug_r=25))
    moved = {name: shrug[name] - rest[name] for name in rest}
    for name, quantity, theirs, sd in (
        ("up", "clavicle up", 25, 5),
        ("back", "clavicle back", 17, 5),
        ("upward", "scapula upward", 26, 4),
        ("internal", "scapula inward", -9, 2),
        ("tilt", "scapula tilts back", -3, 2),
    ):
        t.near(f"{quantity}, shrug of 25", "°", moved[name], theirs, sd, PEETERS, used=True)


def ranges(t, man):
    """Ours against the Academy's handbook, estimates without a spread."""
    source = "AAOS handbook, estimates; allowed 10°"
    t.near("elevation, typical", "°", man.typical("shoulder_elevation_r")[1], 180, 10, source)
    t.near("internal rotation, typical", "°", man.typical("shoulder_rotation_r")[1], 70, 10, source)
    t.near("external rotation, typical", "°", -man.typical("shoulder_rotation_r")[0], 90, 10, source)
