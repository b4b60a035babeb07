"""Trunk, head and neck."""

import numpy as np

from body import Table, tables

TANG = "Tang et al. 2021, 126 adults of 18 to 30"
NIEWIADOMSKI = "Niewiadomski et al. 2019, 97 adults, optoelectronic"
ANSUR_MEN = "ANSUR II, 940 men of 1.73 to 1.77 m"
ANSUR_WOMEN = "ANSUR II, 508 women of 1.60 to 1.64 m"


def rows(man, woman):
    t = Table("trunk, head")
    heights(t, man, woman)
    posture(t, man)
    chest(t, man)
    ranges(t, man)
    return t.rows


def heights(t, man, woman):
    m, w = man.rest.at, woman.rest.at
    t.near("vertex, man", "mm", m("vertex")[1], 1750, 5, "stature", used=True)
    t.near("vertex, woman", "mm", w("vertex")[1], 1620, 5, "stature", used=True)
    t.near("suprasternal notch, man", "mm", m("suprasternal_notch")[1], 1433, 15, ANSUR_MEN, used=True)
    t.near("suprasternal notch, woman", "mm", w("suprasternal_notch")[1], 1321, 15, ANSUR_WOMEN)
    t.near("cervicale, man", "mm", m("spinous_process_c7")[1], 1512, 15, ANSUR_MEN, used=True)
    t.near("cervicale, woman", "mm", w("spinous_process_c7")[1], 1387, 15, ANSUR_WOMEN, used=True)
    t.near("tragion, man", "mm", m("tragion_r")[1], 1619, 6, ANSUR_MEN, used=True)
    source = "; rib 10 was turned down to come nearer to it"
    t.near(
        "tenth rib, lower edge, man", "mm", m("rib_10_end_r")[1] - 6, 1115, 22, ANSUR_MEN + source, used=True
    )
    t.near(
        "tenth rib, lower edge, woman",
        "mm",
        w("rib_10_end_r")[1] - 6,
        1048,
        19,
        ANSUR_WOMEN + source,
        used=True,
    )
    seat = "; the seat is the lowest bone of the ischium"
    sitting = lambda at: at("vertex")[1] - at("ischial_tuberosity_r")[1]
    t.near("sitting height, man", "mm", sitting(m), 916, 22, ANSUR_MEN + seat)
    t.near("sitting height, woman", "mm", sitting(w), 855, 21, ANSUR_WOMEN + seat)
    source = "Tuffier's line: L4-5 as high as the iliac crests, " + ANSUR_MEN
    t.near("disc of L4-5, height", "mm", man.rest.point("vl4")[1], 1056, 22, source, used=True)
    rise = man.rest.point("vc7")[1] - man.rest.point("sacrum")[1]
    t.near("C7-T1 above L5-S1", "mm", rise, 466, 10, "AnyBody's spine (AMMR), a man of about 1.75 m")
    d = m("spinous_process_t8") - m("spinous_process_c7")
    seth = "Seth et al. 2019, landmarks of one model (1.8 m)"
    t.near("tip of T8 from that of C7, forward", "mm", d[0], -46, 15, seth)
    t.near("tip of T8 from that of C7, up", "mm", d[1], -183, 20, seth)


def posture(t, man):
    """Standing. Tilts are those of vertebrae, so of the sacrum 40 degrees are added for its endplate."""
    p = man.rest
    c7, tragion = p.at("spinous_process_c7"), p.at("tragion_r")
    cva = np.degrees(np.arctan2(*(tragion - c7)[[1, 0]]))
    t.near("craniovertebral angle", "°", cva, 48.9, 6, "Raine & Twomey 1997, 160 adults", used=True)
    source = "PMC6680033, 627 volunteers of 20 to 79, endplates"
    t.near("lordosis, T12 to S1", "°", p.tilt("vt12") + 40, 49.8, 11.2, source)
    t.near("lordosis, L4 to S1", "°", p.tilt("vl4") + 40, 34.2, 8.3, source)
    kyphosis = p.tilt("vt12") - p.tilt("vt4")
    t.near("kyphosis, T4 to T12", "°", kyphosis, 38, 9, "textbooks, young men (recalled)")
    t.near(
        "C2 to C7", "°", p.tilt("vc2") - p.tilt("vc7"), 12.7, 6.1, "Guo et al. 2018, 15 364 people", used=True
    )
    t.between("T1 slope", "°", -p.tilt("vt1"), 20, 30, "85 people, biocloudy 3890248", used=True)
    corner = p.point("vc7", (-8, 14, 0))[0]
    sacrum = p.point("sacrum")[0] - 17 * np.cos(np.radians(40))
    t.near(
        "C7 before the rear corner of S1",
        "mm",
        p.point("vc7", (0, 8, 0))[0] - sacrum,
        -21.6,
        31,
        TANG,
        used=True,
    )
    t.near(
        "C2 before the rear corner of C7",
        "mm",
        p.point("vc2", (0, 8, 0))[0] - corner,
        18.6,
        7.9,
        TANG,
        used=True,
    )
    source = TANG + ": the head's centre, here the tragion"
    t.near("head before the rear corner of C7", "mm", tragion[0] - corner, 22.9, 12.3, source)


def centreline(rib, count=200):
    """A rib as Holcombe, Wang & Grotberg 2017 describe it, from a row of the model's text; mm, in the rib's axes."""
    angle = np.radians(rib["angle"])
    x, y = rib["peak"]
    head = np.arctan2(y, x)

    def spiral(b, turns):
        return np.exp(b * turns)[:, None] * np.stack([np.cos(turns), np.sin(turns)], 1)

    # To the front: from the top of a spiral to where the slope from the top is that of the chord's end.
    b = rib["distal"]
    top = 2 * np.arctan(np.hypot(b, 1) + b)
    turns = np.linspace(top, top + 3.1, 20001)
    front = spiral(b, turns) * [-1, 1]
    front -= front[0]
    beyond = front[1:, 1] / front[1:, 0] + y / (1 - x)
    front = front[: 2 + np.flatnonzero((beyond[:-1] > 0) & (beyond[1:] <= 0))[0]]
    front = front * np.hypot(y, 1 - x) / np.linalg.norm(front[-1]) + [x, y]
    # To the rear: a spiral that leaves the peak level, and a straight piece to the head.
    b = rib["proximal"]
    top = 2 * np.arctan(np.hypot(b, 1) + b)
    rear = spiral(b, np.linspace(top + angle - head, top - head, 2000))
    start = np.array([rear[0, 0] - (rear[0, 1] - rear[-1, 1]) / np.tan(angle - head), rear[-1, 1]])
    rear = (np.vstack([start, rear]) - start) * np.hypot(x, y) / (rear[-1, 0] - start[0])
    c, s = np.cos(head), np.sin(head)
    line = np.vstack([rear @ [[c, s], [-s, c]], front[1:]]) * rib["chord"] * 1e3
    arc = np.r_[0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    even = np.linspace(0, arc[-1], count)
    line = np.stack([np.interp(even, arc, line[:, i]) for i in (0, 1)], 1)
    # The chord goes down and out, and the rib's plane is turned about it.
    pump, swing, plane = np.radians([rib["pump"], rib["swing"], rib["plane"]])
    along = np.array([np.cos(pump) * np.cos(swing), -np.sin(pump), np.cos(pump) * np.sin(swing)])
    outward = np.array([-np.sin(swing), 0, np.cos(swing)])
    outward = np.cos(plane) * outward + np.sin(plane) * np.cross(outward, along)
    return line @ [along, outward], arc[-1]


def chest(t, man):
    p = man.rest
    template = tables("parts/rib-cage.toml")["template"]["rib_bone"]
    ribs = {row[0]: centreline(dict(zip(template["parameters"], row))) for row in template["instances"]}
    lines = {k: np.array([p.point(f"rib_{k}_r", x) for x in line]) for k, (line, _) in ribs.items()}
    # Chest breadth and depth are measured at the height of the nipples.
    cage = np.vstack(list(lines.values()))
    level = cage[abs(cage[:, 1] - 1285) < 8]
    t.near("chest breadth, bone and 2 x 12 of tissue", "mm", 2 * level[:, 2].max() + 24, 289, 17, ANSUR_MEN)
    notch, angle, end = (p.at(n) for n in ("suprasternal_notch", "sternal_angle", "xiphisternal_joint"))
    front = np.interp(-1285, [-angle[1], -end[1]], [angle[0], end[0]])
    source = ANSUR_MEN + ": 253 ± 25 less 50 to 70 of muscle and skin (recalled)"
    t.between("chest depth, bone", "mm", front + 6 - level[:, 0].min(), 158, 228, source)
    # Of a cage 11 % larger only the proportions say something.
    mesh = {3: 291, 4: 325, 5: 344, 7: 344, 8: 331, 9: 304}
    source = "meshes of Bruno et al. 2015, one man; allowed 5 %"
    for k, theirs in mesh.items():
        theirs /= 352
        t.near(
            f"arc of rib {k} to that of rib 6",
            "",
            ribs[k][1] / ribs[6][1],
            round(theirs, 3),
            round(0.05 * theirs, 3),
            source,
            digits=3,
        )
    source = "22 patients with pectus carinatum, CT"
    for k, length in ((4, 56), (5, 71), (6, 99)):
        t.near(
            f"cartilage of rib {k}",
            "mm",
            p.distance(f"rib_{k}_end_r", f"sternum_rib_{k}_r"),
            length,
            15,
            source,
        )
    source = "bibliomed 16478, CT of 30 men"
    upper, lower = angle - notch, end - angle
    t.near("manubrium", "mm", np.linalg.norm(upper), 53.6, 6, source)
    t.near("body of the sternum", "mm", np.linalg.norm(lower), 101.1, 6, source)
    bend = np.degrees(np.arccos(upper @ lower / np.linalg.norm(upper) / np.linalg.norm(lower)))
    t.near("sternal angle", "°", 180 - bend, 161.4, 3, source)
    x = p.at("xiphoid_process") - notch
    source = "Seth et al. 2019 178, Blana et al. 2008 137"
    t.between("notch to xiphoid process", "mm", np.hypot(x[0], x[1]), 137, 179, source, used=True)

    def stretch(**pose):
        q = man.pose(**pose)
        return max(
            abs(
                q.distance(f"rib_{k}_end_{s}", f"sternum_rib_{k}_{s}")
                - p.distance(f"rib_{k}_end_{s}", f"sternum_rib_{k}_{s}")
            )
            for k in range(1, 8)
            for s in "rl"
        )

    source = "cartilage does not stretch; the ribs' parts were solved for it"
    t.between(
        "change of a cartilage, thorax bent by 17.5°",
        "mm",
        stretch(thoracic_bending=17.5),
        0,
        3,
        source,
        used=True,
    )
    t.between(
        "change of a cartilage, thorax turned by 26°",
        "mm",
        stretch(thoracic_rotation=26),
        0,
        3,
        source,
        used=True,
    )


def ranges(t, man):
    p = man.rest

    def head(**pose):
        """Flexion, bending, rotation of the head against rest."""
        r = man.pose(**pose).axes("skull") @ p.axes("skull").T
        flexion = -np.degrees(np.arctan2(-r[0, 1], r[1, 1]))
        return np.array([flexion, np.degrees(np.arcsin(r[2, 1])), np.degrees(np.arctan2(-r[2, 0], r[2, 2]))])

    def whole(motion, index):
        ends = zip(man.typical(f"cervical_{motion}"), man.typical(f"head_{motion}"))
        low, high = (head(**{f"cervical_{motion}": c, f"head_{motion}": h})[index] for c, h in ends)
        return high - low

    t.near("neck, flexion and extension, typical", "°", whole("flexion", 0), 127.4, 15.1, NIEWIADOMSKI)
    t.near("neck, bending to both sides, typical", "°", whole("bending", 1), 89.3, 12, NIEWIADOMSKI)
    t.near("neck, rotation to both sides, typical", "°", whole("rotation", 2), 146.4, 13, NIEWIADOMSKI)
    source = "dual fluoroscopy, eight women, J Biomech 2021"
    t.near(
        "head tilt with the neck turned by 55°",
        "°",
        abs(head(cervical_rotation=55)[1]),
        3.2,
        5,
        source,
        used=True,
    )

    order = ["sacrum", "vl5", "vl4", "vl3", "vl2", "vl1", "vt12"]

    def level(pose, above, below, index):
        r = pose.axes(below).T @ pose.axes(above)
        s = p.axes(below).T @ p.axes(above)
        r = r @ s.T
        return np.degrees((np.arctan2(r[0, 1], r[1, 1]), np.arcsin(r[2, 1]))[index])

    low, high = (man.pose(lumbar_flexion=x) for x in man.typical("lumbar_flexion"))
    names = ["L5-S1", "L4-5", "L3-4", "L2-3", "L1-2"]
    for name, above, below in zip(names, order[1:], order):
        span = level(high, above, below, 0) - level(low, above, below, 0)
        t.between(
            f"{name}, flexion and extension, typical",
            "°",
            span,
            7,
            14,
            "Hayes et al. 1989, 59 healthy men, films",
        )
    necks = ["vt1", "vc7", "vc6", "vc5", "vc4", "vc3", "vc2"]
    lan = {"vc2": 7.7, "vc3": 8.4, "vc4": 8.9, "vc5": 7.2, "vc6": 6.3}
    bent = man.pose(cervical_bending=man.typical("cervical_bending")[1])
    ours = {n: level(bent, n, necks[necks.index(n) - 1], 1) for n in lan}
    for n, theirs in lan.items():
        k = int(n[2])
        share, wanted = ours[n] / sum(ours.values()), theirs / sum(lan.values())
        t.near(
            f"C{k}-{k + 1}, share of C2 to C7 in bending",
            "",
            share,
            round(wanted, 3),
            0.03,
            "Lan et al. 2014, 46 healthy people",
            digits=3,
        )
    end = lambda name: man.typical(name)[1]
    t.between(
        "trunk rotation to one side, typical",
        "°",
        end("trunk_rotation"),
        36,
        50,
        "textbooks, active: 40 to 45 (recalled), ± 10 %",
    )
    t.between(
        "trunk bending to one side, typical",
        "°",
        end("trunk_bending"),
        27,
        38.5,
        "textbooks, active: 30 to 35 (recalled), ± 10 %",
    )
    t.between(
        "trunk flexion, typical",
        "°",
        end("trunk_flexion"),
        63,
        88,
        "textbooks, active: 70 to 80 (recalled), ± 10 %",
    )
    t.between(
        "trunk extension, typical",
        "°",
        -man.typical("trunk_flexion")[0],
        18,
        27.5,
        "textbooks, active: 20 to 25 (recalled), ± 10 %",
    )
    low, high = man.range("lumbar_flexion")
    t.near(
        "lumbar flexion and extension, range",
        "°",
        high - low,
        96,
        9.6,
        "range of Christophy et al. 2012, a model",
    )
    t.near(
        "lumbar rotation to one side, typical",
        "°",
        end("lumbar_rotation"),
        7,
        2,
        "Troke et al. 2005, 405 people (recalled)",
    )
