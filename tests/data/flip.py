"""Writes flip.json: NVIDIA's FLIP evaluator and numpy on five procedural pairs, for tests/tests/ruler_flip.rs.

pip install flip-evaluator numpy; python flip.py > flip.json
The test holds the same formulas. They use +, -, *, / and sqrt in one order, so that both get the same bits.
"""
import json
from math import sqrt

import flip_evaluator
import numpy as np

W, H = 128, 96


def scene(x, y, soft):
    """A lit ball over a checkerboard, its shadow soft (the truth) or hard (the fake); linear RGB."""
    bx, by = (x - 52.0) / 28.0, (y - 38.0) / 28.0
    d2 = bx * bx + by * by
    if d2 < 1.0:
        bz = sqrt(1.0 - d2)
        lit = max(0.0, -0.48 * bx - 0.6 * by + 0.64 * bz)
        gloss = max(0.0, -0.265 * bx - 0.331 * by + 0.906 * bz)
        for _ in range(6):
            gloss = gloss * gloss
        shade = 0.05 + 0.95 * lit
        return [0.9 * shade + 9.0 * gloss, 0.3 * shade + 9.0 * gloss, 0.2 * shade + 9.0 * gloss]
    ex, ey = (x - 78.0) / 34.0, (y - 70.0) / 14.0
    e = ex * ex + ey * ey
    covered = min(max(1.5 - e, 0.0), 1.0) if soft else (1.0 if e < 1.0 else 0.0)
    light = 1.0 - 0.85 * covered
    floor = [0.8, 0.78, 0.7] if (x // 16 + y // 12) % 2 == 0 else [0.06, 0.1, 0.25]
    return [c * light for c in floor]


def hashed(i):
    """A number in [0, 1) for an integer: O'Neill's PCG output function."""
    s = (i * 747796405 + 2891336453) & 0xFFFFFFFF
    s = (((s >> ((s >> 28) + 4)) ^ s) * 277803737) & 0xFFFFFFFF
    return ((s >> 22) ^ s) / 4294967296.0


def picture(of):
    return [[of(x, y) for x in range(W)] for y in range(H)]


truth = picture(lambda x, y: scene(x, y, True))


def at(x, y):
    return truth[min(max(y, 0), H - 1)][min(max(x, 0), W - 1)]


def noisy(x, y):
    return [v * (0.5 + hashed((y * W + x) * 3 + c)) for c, v in enumerate(at(x, y))]


def blurred(x, y):
    total = [0.0, 0.0, 0.0]
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            total = [t + v for t, v in zip(total, at(x + dx, y + dy))]
    return [t / 9.0 for t in total]


def tinted(x, y):
    r, g, b = at(x, y)
    return [r * 0.8, g, b * 1.25]


PAIRS = {
    "noise": noisy,
    "shift": lambda x, y: at(x - 1, y),
    "blur": blurred,
    "colour": tinted,
    "fake": lambda x, y: scene(x, y, False),
}


def code(linear):
    """Bytes over a gamma of 2, as code values: what is compared as shown."""
    return (np.floor(np.sqrt(np.clip(linear, 0.0, 1.0)) * 255.0 + 0.5) / 255.0).astype(np.float32)


def measured(of):
    a, r = np.array(picture(of)), np.array(truth)
    ldr, ldr_mean, _ = flip_evaluator.evaluate(code(r), code(a), "LDR", True, False)
    linear = [np.ascontiguousarray(p, dtype=np.float32) for p in (r, a)]
    hdr, hdr_mean, used = flip_evaluator.evaluate(*linear, "HDR", False, False)
    r, a = (p.astype(np.float64) for p in linear)
    d = a - r
    return {
        "ldr_mean": float(ldr_mean), "ldr_max": float(ldr.max()),
        "hdr_mean": float(hdr_mean), "hdr_max": float(hdr.max()),
        "hdr_exposures": int(used["numExposures"]),
        "hdr_first": float(used["startExposure"]), "hdr_last": float(used["stopExposure"]),
        "rmse": float(np.sqrt((d * d).mean())), "rel_mse": float((d * d / (r * r + 0.01)).mean()),
        "mae": float(np.abs(d).mean()), "bias": float(d.mean()),
    }


about = ("Five procedural pairs of 128 x 96 pixels against one reference. FLIP by NVIDIA's flip-evaluator 1.7 at its "
         "67.02 pixels per degree, HDR under ACES with its own exposures; the other metrics by numpy in float64 over "
         "the float32 pictures. Made by flip.py beside this file for this project; no licence but the project's own.")
print(json.dumps({"about": about, "pairs": {name: measured(of) for name, of in PAIRS.items()}}, indent=1))
