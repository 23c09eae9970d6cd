"""The single pair with backlash by pyHarm, with more harmonics and shorter steps than ours takes."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.backlash.solver.continuation import follow
from validation.race import pyharm_peer
from validation.race.backlash import BEGIN, END, branch_rms, pair, pair_for_pyharm, turning

AMPLITUDES = (0.02, 0.05)
HARMONICS, INSTANTS, STEP = 13, 4096, 0.002
#: share of the way between both turning points at which three motions are told
BETWEEN = 0.35


def rows() -> list[dict[str, Any]]:
    """Turning points of either program, and rms of the three motions at one speed between them."""
    out = []
    for amplitude in AMPLITUDES:
        branch = follow(pair(amplitude), BEGIN, END)
        given = pair_for_pyharm(amplitude)
        found = pyharm_peer.solve(harmonics=HARMONICS, instants=INSTANTS, step=STEP, **given)
        omega = np.array(found["omega"])
        ours = branch.omega[list(branch.turning)]
        at = float(ours.min() + BETWEEN * np.ptp(ours))
        common = {"amplitude": amplitude, "at": at}
        own = sorted(p.rms[0] for p in branch.at(at))
        theirs = branch_rms(omega, np.array(found["stretch"]), at)
        name = f"pyHarm {found['version']}"
        out.append(common | {"by": "ours", "turning": ours.tolist(), "rms": own})
        out.append(common | {"by": name, "turning": turning(omega), "rms": sorted(theirs)})
    return out
