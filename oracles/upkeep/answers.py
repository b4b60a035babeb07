#!/usr/bin/env python3
"""What SciPy and NumPy make of one signal: filtered, filled, resampled, differentiated.

    pip install numpy scipy
    python answers.py > answers.json

The signal is x(i) = sin(0.37 i) + 0.3 cos(1.9 i) + 0.01 i at 100 rows a second, 60 rows. Uneven times are
t(i) = 0.01 i + 0.003 sin(i).

Butterworth: `scipy.signal.butter(2, w)` and `filtfilt` with odd padding over three periods of the cut-off, but at least 9
values. SciPy's w is that of one pass, so it is corrected: tan(pi w / 2) = tan(pi f / F) / (sqrt(2) - 1)^(1/4).
"""
import json
import math
import sys

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, filtfilt

RATE = 100.0
i = np.arange(60)
x = np.sin(0.37 * i) + 0.3 * np.cos(1.9 * i) + 0.01 * i
even = i / RATE
uneven = 0.01 * i + 0.003 * np.sin(i)


def low_pass(hertz):
    w = 2 / math.pi * math.atan(math.tan(math.pi * hertz / RATE) / (math.sqrt(2) - 1) ** 0.25)
    b, a = butter(2, w)
    reach = min(max(math.ceil(3 * RATE / hertz), 9), len(x) - 1)
    return filtfilt(b, a, x, padtype="odd", padlen=reach).tolist()


def filled(gone):
    seen = np.setdiff1d(i, gone)
    return CubicSpline(uneven[seen], x[seen])(uneven[gone]).tolist()


grid = uneven[0] + np.arange(math.floor((uneven[-1] - uneven[0]) * 37 + 1e-6) + 1) / 37
json.dump(
    {
        "low_pass_6": low_pass(6.0),
        "low_pass_20": low_pass(20.0),
        "filled": filled([1, 20, 21, 22, 40, 58]),
        "resampled_37": CubicSpline(uneven, x)(grid).tolist(),
        "short": [CubicSpline(uneven[:n], x[:n])(0.5 * (uneven[0] + uneven[1])).tolist() for n in (2, 3, 4)],
        "differentiated": np.gradient(x, uneven, edge_order=2).tolist(),
    },
    sys.stdout,
    indent=1,
)
print()
