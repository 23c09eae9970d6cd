"""The ladder: every model there is, cheapest first.  Whatever lists models goes through it."""

from __future__ import annotations

from solidgear.fidelity.levels import (
    corrected_meshes,
    harmonic_meshes,
    sector_meshes,
    solid_meshes,
)
from solidgear.fidelity.options import (
    BEAM_OPTIONS,
    CORRECTED_OPTIONS,
    HARMONIC_OPTIONS,
    SECTOR_OPTIONS,
    SOLID_OPTIONS,
)
from solidgear.fidelity.rung import (
    BEAM,
    CUTS,
    CYCLIC,
    HELD,
    HELD_AT_A_STEP,
    HELD_PLANE,
    LUMPED,
    PARTS,
    PLANE,
    SMOOTH,
    SOLID,
    STEPPED,
    STEPPED_PLANE,
    BandFactors,
    Ladder,
    Later,
    Rung,
    by_edge,
)

LADDER = Ladder(
    Rung(
        name="lumped",
        title="lumped model",
        short="lumped",
        family=LUMPED,
        colour="#b3305c",
        marker="P",
    ),
    Rung(
        name="euler",
        title="Euler beam",
        short="Euler",
        family=BEAM,
        build=Later("solidgear.fidelity.beam", "beam"),
        options=BEAM_OPTIONS,
        preset={"shear": False, "rotary_inertia": False},
        size=Later("solidgear.fidelity.sizes", "beam_size"),
        series=Later("solidgear.fidelity.series", "euler_series"),
        most_seats=200,
        colour="#c98a00",
        marker="v",
    ),
    Rung(
        name="timoshenko",
        title="Timoshenko beam",
        short="Timoshenko",
        family=BEAM,
        build=Later("solidgear.fidelity.beam", "beam"),
        options=BEAM_OPTIONS,
        size=Later("solidgear.fidelity.sizes", "beam_size"),
        series=Later("solidgear.fidelity.series", "timoshenko_series"),
        most_seats=200,
        colour="#0072b2",
        marker="s",
    ),
    Rung(
        name="harmonic",
        title="harmonic solid",
        short="harmonic",
        family=SOLID,
        theory="exact 3D elasticity of a body of revolution",
        build=Later("solidgear.fidelity.harmonic", "harmonic"),
        options=HARMONIC_OPTIONS,
        size=Later("solidgear.fidelity.sizes", "harmonic_size"),
        meshes=harmonic_meshes,
        factors=BandFactors(
            # A layer leaves q**(2 a) of what an edge of exponent a costs, and all that follow
            # q**(2 a) / (1 - q**(2 a)): 0.04, 0.21, 0.25 and 0.53 for q = 0.2. Measured on 71 random
            # shafts (seeds 80001 to 80120) and 34 more (53001 to 53020, 53101 to 53120), 98 % of errors
            # over their last step, after two meshes: 0.5 on smooth shafts, 0.7 with section ties,
            # 0.2 at shoulders (0.28 on one gearbox shaft), 0.35 at shoulders with section ties, 0.28 at
            # rigid seats, all of it where the step is above 1e-4; below, up to 1.2 at section ties and
            # on smooth shafts. A seat that ends 0.07 mm beside a step has 0.36, a smooth thin tube 0.77,
            # a section's plane close beside a rigid seat on a thin tube 0.9 of the stiffness with that
            # seat held; seats of one to two radii on a rotor or a gearbox shaft 0.3, below errors of 3e-4.
            # After three: below 0.1 (0.15 in a disc of 0.05 diameters), 0.1, 0.2, 0.1, 0.2, and 0.4 at
            # rigid seats beside steps.
            usual={
                SMOOTH: 0.2,
                PLANE: 0.15,
                STEPPED: 0.22,
                STEPPED_PLANE: 0.22,
                HELD: 0.25,
                HELD_PLANE: 0.25,
                HELD_AT_A_STEP: 0.5,
            },
            first={
                SMOOTH: (1.2, 1e-4, 0.8),
                PLANE: (1.5, 3e-4, 0.7),
                STEPPED: (0.6, 3e-4, 0.25),
                STEPPED_PLANE: (1.2, 3e-4, 0.4),
                HELD: (1.2, 2e-4, 0.26),
                HELD_PLANE: (1.5, 3e-4, 1.0),
                HELD_AT_A_STEP: (1.2, 2e-4, 0.26),
            },
            # A mode strains all of the shaft, an edge is a small part of it: of 382 errors of
            # frequencies 98 % are below 0.11, 0.2, 0.17 and 0.21 of the last step at the last four.
            # In an umbrella mode of a thin flange the shoulder is most of it: 0.2; on a stiff bearing
            # what its seat indents is, as of a compliance: 0.26 (axial 1 of a stepped shaft, 1e8 N/m
            # and more on 10 mm).
            first_of_modes={
                PLANE: (1.5, 3e-4, 0.4),
                STEPPED: (0.6, 3e-4, 0.3),
                STEPPED_PLANE: (0.6, 1.5e-4, 0.3),
                HELD: (0.6, 1.5e-4, 0.2),
                HELD_PLANE: (0.6, 1.5e-4, 0.4),
                HELD_AT_A_STEP: (0.6, 1.5e-4, 0.26),
            },
            earlier=0.03,
            ahead=0.12,
            # What an edge of exponent a costs falls with the order as p**(-4 a), so that a step from
            # p - 1 to p leaves 1 / ((p / (p - 1))**(4 a) - 1) of itself: at ends of seats 0.7, 0.9 and
            # 1.2 for p of 5 to 7, at shoulders 1.6, 2.0 and 2.5, at rigid seats 1.8, 2.3 and 2.8, at both
            # at once 2.9, 3.6 and 4.4; all else falls exponentially, and layers take their part. Measured
            # on 204 random shafts (seeds 53001 to 69100), 98 % of some 6,000 errors over their step for p
            # of 3, 3 and 4 with 0, 1 and 2 layers: 0.6, 0.3, 0.3 on smooth shafts, 1.0, 1.0, 0.3 with
            # section ties, 1.4, 0.45, 0.5 at shoulders, 1.3, 0.5, 0.4 with section ties, 2.2, 0.8, 1.1 at
            # rigid seats, 1.7, 0.8, 1.2 with section ties, 1.9, 1.3, 0.8 where both meet. Families of
            # simple shafts, rotor_disc and 60 further shafts (seeds 70001 to 70060) want 2.2 and 0.7 at
            # shoulders, 2.8 and 1.4 at rigid seats, 2.1, 2.3 and 3.4 where both meet, as an exponent of
            # 0.3 leaves. Of higher orders theory is taken, at shoulders three quarters of it.
            same_mesh={
                SMOOTH: (0.8, 0.45, 0.4, 0.7, 0.9, 1.2),
                PLANE: (1.6, 1.6, 0.5, 0.7, 0.9, 1.2),
                STEPPED: (2.3, 0.6, 0.8, 1.2, 1.5, 1.8),
                STEPPED_PLANE: (2.3, 0.7, 0.8, 1.2, 1.5, 1.8),
                HELD: (2.9, 0.95, 1.4, 1.8, 2.3, 2.8),
                HELD_PLANE: (2.1, 1.15, 1.4, 1.8, 2.3, 2.8),
                HELD_AT_A_STEP: (3.4, 2.4, 2.6, 3.4, 4.2, 5.0),
            },
        ),
        share=20.0,
        from_above=True,
        series=Later("solidgear.fidelity.series", "harmonic_series"),
        most_seats=60,
        colour="#00805e",
        marker="o",
    ),
    Rung(
        name="corrected",
        title="corrected harmonic solid",
        short="corrected",
        family=SOLID,
        theory="exact 3D elasticity of the plain part, corrected by what features change in 3D",
        build=Later("solidgear.fidelity.corrected", "corrected"),
        options=CORRECTED_OPTIONS,
        size=Later("solidgear.fidelity.sizes", "corrected_size"),
        meshes=corrected_meshes,
        factors=BandFactors(
            # Of both parts at once, whose meshes are finer from level to level. On 22 random parts 95 %
            # of errors are below 3.7 times the last change after two and three meshes, half below 0.6;
            # the 9 after them had six misses of one flat in its first change at 3.5.
            usual=by_edge(3.5, 5.0),
            first=by_edge((5.0, 0.0, 5.0), (7.0, 0.0, 7.0)),
            earlier=0.5,
            ahead=0.5,
            # Meshes may agree and err all the same: a flat with a keyway agreed by accident, few free
            # modes are turned from one mesh to the other, the residual mass is that of the plain part.
            # Where a step did not tell of them, errors on 31 random parts were up to 0.2 of what
            # features change after two meshes, 0.15 after three, but for five of 318 below 0.07 then,
            # and for five of 304 below 0.05 after four (docs/validation/random.md); on 9 others 0.2 of
            # axial 1, where mass and stiffness that are cut away nearly cancel, and 0.4 of torsion 1, a
            # free mode.
            effect={
                **dict.fromkeys(("C_zz", "C_z,thx", "C_thx", "C_yy"), 0.2),
                **dict.fromkeys(("C_xx", "C_x,thz", "C_thz", "C_thy"), 0.2),
                **dict.fromkeys(("K_zz", "K_z,thx", "K_thx", "K_yy"), 0.28),
                **dict.fromkeys(("K_xx", "K_x,thz", "K_thz", "K_thy"), 0.28),
                **dict.fromkeys(("bending 1", "bending 2"), 0.2),
                "axial 1": 0.4,
                "torsion 1": 0.8,
            },
            # an accident of two meshes is rarer with three; singular edges by themselves leave 0.7
            shrinks=0.5,
            plain="harmonic",
        ),
        share=3.0,
        section_ties=False,
        holds=(CUTS,),
        nature="made of two meshes, with cuts and without,",
        for_features=True,
        mass_tolerance=1e-3,
        series=Later("solidgear.fidelity.series", "corrected_series"),
        most_seats=12,
        colour="#a05a00",
        marker="^",
    ),
    Rung(
        name="sector",
        title="cyclic sector",
        short="sector",
        family=SOLID,
        theory="full 3D elasticity of a part of equal sectors, with its teeth",
        build=Later("solidgear.fidelity.sector", "sector"),
        options=SECTOR_OPTIONS,
        size=Later("solidgear.fidelity.sizes", "sector_size"),
        meshes=sector_meshes,
        factors=BandFactors(
            # Lands and tips of teeth hold one cell from the first mesh to the third, or two on the way,
            # and every middle plane and cut face is an edge of cells: such a place keeps its error over
            # a step, and gives it up in the next one. So an observed order says nothing, and the larger
            # of two changes counts. On eight parts (splines, toothed heads, bolt circles) 98 % of
            # errors are below 2.1 of what a change leaves after two meshes, 1.8 after three
            # (python -m validation.real_parts --judge --sort cyclic, docs/validation/random.md).
            rough=(3.0, 2.5),
            singular=True,
        ),
        section_ties=False,
        holds=(CYCLIC,),
        limits=Later("solidgear.fidelity.sector", "no_sector"),
        nature="one sector that repeats itself around the axis,",
        for_features=True,
        mass_tolerance=1e-3,
        series=Later("solidgear.fidelity.series", "sector_series"),
        most_seats=12,
        colour="#c2185b",
        marker="h",
    ),
    Rung(
        name="solid",
        title="3D solid",
        family=SOLID,
        theory="full 3D elasticity",
        build=Later("solidgear.fidelity.solid", "solid"),
        options=SOLID_OPTIONS,
        size=Later("solidgear.fidelity.sizes", "solid_size"),
        meshes=solid_meshes,
        factors=BandFactors(
            # of hexahedra on seats near shoulders errors fall by half a mesh, and what is left is as
            # much as the last step: 1.0 on the overhung pinion, 1.1 on a random rotor (64014)
            usual=by_edge(1.2, 1.5),
            first=by_edge((1.8, 0.009, 0.6), (1.8, 0.036, 0.8)),
            earlier=0.15,
            ahead=0.4,
            singular=True,
        ),
        section_ties=False,
        holds=(CUTS, CYCLIC, PARTS),
        limits=Later("solidgear.fidelity.sector", "no_sector"),
        nature="one mesh of tetrahedra,",
        copies=CYCLIC,
        featured={"element": "tet10"},
        mass_tolerance=1e-3,
        series=Later("solidgear.fidelity.series", "solid_series"),
        most_seats=12,
        colour="#5a3e8c",
        marker="D",
    ),
)
