"""Break the physics on purpose, one expression at a time, and see a named test go red.

Every mutation is one expression or statement of one function, found by the syntax tree, so that
neither layout nor what stands around it matters.  It is replaced in a copy of the source; its test
must pass before and fail after.

    python -m validation.mutations [--only WORD] [--jobs 2]
"""

from __future__ import annotations

import argparse
import ast
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from validation.common import ROOT, results_folder, show, write_rows

PARTS = ("solidgear", "geometry", "tests", "validation", "pyproject.toml")


@dataclass(frozen=True)
class Mutation:
    """One wrong expression of physics and the test that must notice it.

    Attributes
    ----------
    name : str
    file : str
    where : str
        Function, or class and method, such as ``Body.ports``.
    old, new : str
        Expression or statement that occurs there exactly once, and what replaces it.
    test : str
    """

    name: str
    file: str
    where: str
    old: str
    new: str
    test: str


MUTATIONS = (
    Mutation(
        "the kinetic energy of spin counts once in the whirl of a shaft",
        "solidgear/core/solve/spin.py",
        "whirled",
        "-2 * turns * coupling",
        "-turns * coupling",
        "tests/test_spin.py::test_rotor_of_friswell",
    ),
    Mutation(
        "only the mean of a held seat is held",
        "solidgear/core/scene/stations.py",
        "usual_attachment",
        'return "rigid"',
        'return "average"',
        "tests/test_holds.py::test_the_clamped_foot_of_a_block_does_not_deform",
    ),
    Mutation(
        "a narrow seat is meshed as a wide one",
        "solidgear/core/meshing/grading.py",
        "Grading.seat_layers",
        "return max(0, more)",
        "return 0",
        "tests/test_layout.py::test_cells_beside_a_narrow_seat_are_no_longer_than_it",
    ),
    Mutation(
        "a narrow seat on a plain bar has no layer",
        "solidgear/core/meshing/grading.py",
        "Grading.seat_layers",
        "return int(width < DEEP * max(ungraded_depth(segments, k) for k in seat_segments) * (1 - ROUNDING))",
        "return 0",
        "tests/test_layout.py::test_a_seat_narrower_than_a_few_depths_of_its_cells_has_a_layer",
    ),
    Mutation(
        "weight: what is cut out of a shaft still weighs",
        "solidgear/core/scene/own_mass.py",
        "own_mass",
        "outline.mass + sum((part.mass for part in further))",
        "outline.mass",
        "tests/test_own_body.py::test_mass_and_centre_of_cuts_are_those_of_the_kernel",
    ),
    Mutation(
        "stress: sections that are not round are taken as discs",
        "solidgear/strength/stress/nominal.py",
        "nominal_rows",
        "any((lo < inside < hi for lo, hi in uneven))",
        "False",
        "tests/test_own_body.py::test_sections_that_are_not_round_have_no_nominal_stress",
    ),
    Mutation(
        "bounds: the richer space has one order more only",
        "solidgear/core/bounds/richer_space.py",
        "RicherSpace.__init__",
        "self.order + EXTRA",
        "self.order + 1",
        "tests/test_bounds.py::test_errors_are_within_bars_and_bars_hardly_wider",
    ),
    Mutation(
        "bounds: no cuts towards corners in the richer space",
        "solidgear/core/bounds/richer_space.py",
        "RicherSpace.__init__",
        "LAYERS if place.sharp else min(1, LAYERS)",
        "0",
        "tests/test_bounds.py::test_errors_are_within_bars_and_bars_hardly_wider",
    ),
    Mutation(
        "bounds: what two cuts leave of a corner is nothing",
        "solidgear/core/bounds/richer_space.py",
        "RicherSpace.unseen",
        "1 / (1 - left)",
        "1.0",
        "tests/test_singular_places.py::test_answers_at_two_tolerances_hold_what_is_right",
    ),
    Mutation(
        "corners: a rigid seat holds the face beyond its end",
        "solidgear/core/meshing/meeting.py",
        "meeting",
        "Meeting(tuple(merged((end - start, material) for start, end, material in row)), held)",
        "Meeting(tuple(merged((end - start, material) for start, end, material in row)), held[::-1])",
        "tests/test_singular_places.py::test_the_exponent_at_an_end_is_of_what_meets_there",
    ),
    Mutation(
        "corners: the rim of a held face is free on both sides",
        "solidgear/core/meshing/meeting.py",
        "_holds",
        "on_face(seat) and abs(seat.y - y) <= tol",
        "False",
        "tests/test_singular_places.py::test_the_rims_of_a_held_face_are_held_on_one_side",
    ),
    Mutation(
        "a held face is held at its rim beside it",
        "solidgear/core/models/harmonic/blocks.py",
        "Work.side",
        "attachment != 'section' and (not on_face(station))",
        "attachment != 'section'",
        "tests/test_holds.py::test_bars_of_a_clamped_face_hold_finite_elements_of_another_code",
    ),
    Mutation(
        "bounds: hats of a rigid seat are not one",
        "solidgear/core/bounds/richer_space.py",
        "RicherSpace._seats",
        "joined += [np.array([ends[0], v]) for v in ends[1:]]",
        "pass",
        "tests/test_bounds.py::test_errors_are_within_bars_and_bars_hardly_wider",
    ),
    Mutation(
        "life: both rings turn against the load",
        "solidgear/bearings/reference_life.py",
        "damage",
        "law.turning if ring == turning else law.standing",
        "law.turning",
        "tests/test_bearing_life.py::test_published_reference_lives",
    ),
    Mutation(
        "life: a pair rates as two single bearings",
        "solidgear/bearings/rating.py",
        "ratings",
        "2 ** ROW_POWER[data.balls]",
        "2",
        "tests/test_manual.py::test_case[printed_pair_rating-A]",
    ),
    Mutation(
        "life: f_0 without the outer ring",
        "solidgear/bearings/rating.py",
        "static_ball_rating",
        "min((ring.load(pressure) for ring in row.rings))",
        "row.rings[0].load(pressure)",
        "tests/test_bearing_life.py::test_static_factor_is_that_of_iso_76",
    ),
    Mutation(
        "floating: y is struck out of the stiffness",
        "solidgear/bearings/rolling.py",
        "RollingBearing.tangent",
        "condense_y(stiffness)",
        "stiffness",
        "tests/test_bearing_support.py::test_a_floating_bearing_is_the_same_bearing_under_its_other_loads_alone",
    ),
    Mutation(
        "floating: rings stay where the seat is",
        "solidgear/bearings/rolling.py",
        "RollingBearing.ring_motion",
        "slide_to_balance(self._load, self._tangent, motion, -limit, limit)",
        "motion",
        "tests/test_bearing_support.py::test_a_thrust_elsewhere_leaves_a_floating_bearing_as_it_is",
    ),
    Mutation(
        "pairs: as the file has them",
        "solidgear/bearings/arrangement.py",
        "Pair.ways",
        "sorted(zip(places, self.bearings))",
        "zip(places, self.bearings)",
        "tests/test_bearing_support.py::test_one_word_stands_for_the_directions_of_both_bearings",
    ),
    Mutation(
        "spherical: rollers are cylinders",
        "solidgear/bearings/spherical.py",
        "SphericalRow.drop",
        "self.along**2 / 4",
        "0.0 * self.along",
        "tests/test_bearings_spherical_thrust.py::test_barrels_press_in_ellipses_and_then_in_lines",
    ),
    Mutation(
        "spherical: rollers stand across",
        "solidgear/bearings/spherical.py",
        "SphericalRow._normal",
        "self.side * np.sin(self.angle)",
        "0.0",
        "tests/test_bearings_spherical_thrust.py::test_a_spherical_roller_bearing_in_equilibrium_by_hand",
    ),
    Mutation(
        "thrust: washers are loaded by half",
        "solidgear/bearings/reference_life.py",
        "raceways",
        "THRUST",
        "POINT",
        "tests/test_bearings_spherical_thrust.py::test_ratings_and_inside_of_thrust_balls_are_a_makers",
    ),
    Mutation(
        "thrust: balls feel the shaft move across",
        "solidgear/bearings/ball.py",
        "ThrustBallRow._stretch",
        "np.zeros_like(axial)",
        "np.ones_like(axial)",
        "tests/test_bearings_spherical_thrust.py::test_thrust_balls_in_closed_form",
    ),
    Mutation(
        "bounds: bearings do not push a mode",
        "solidgear/core/bounds/harmonic.py",
        "_vibrating",
        "on_ports(block, residual)",
        "0.0 * on_ports(block, residual)",
        "tests/test_bounds.py::test_errors_are_within_bars_and_bars_hardly_wider",
    ),
    Mutation(
        "bounds: rigid motions of a patch are left in",
        "solidgear/core/kernel/local_problems.py",
        "_solved",
        "_orthonormal(rigid[ids] / root[:, None])",
        "_orthonormal(0.0 * rigid[ids])",
        "tests/test_patches.py::test_what_does_not_balance_moves_a_patch_as_a_rigid_body_and_costs_nothing",
    ),
    Mutation(
        "bounds: rounding of a rigid motion counts as stiffness",
        "solidgear/core/kernel/local_problems.py",
        "_stiffen",
        "stiffness @ free",
        "0.0 * free",
        "tests/test_patches.py::test_what_rounding_leaves_a_rigid_motion_is_no_stiffness",
    ),
    Mutation(
        "bounds: of the hats of a cell the last one counts alone",
        "solidgear/core/kernel/local_problems.py",
        "energies",
        "solutions[k] += x",
        "solutions[k] = x",
        "tests/test_patches.py::test_what_was_condensed_and_what_was_not_bound_the_same",
    ),
    Mutation(
        "bounds: a near mode does not matter",
        "solidgear/core/bounds/clusters.py",
        "lower_ends",
        "shared / gap",
        "shared",
        "tests/test_bounds.py::test_the_next_mode_widens_a_bound_as_far_as_it_is_near",
    ),
    Mutation(
        "bounds: near modes keep their places",
        "solidgear/core/bounds/clusters.py",
        "lower_ends",
        "found[k]",
        "(values[k] - shared[k, k] / gap)",
        "tests/test_bounds.py::test_modes_that_may_change_places_share_their_lower_ends",
    ),
    Mutation(
        "bounds: near modes share no error",
        "solidgear/core/bounds/clusters.py",
        "lower_ends",
        "np.equal.outer(number, number)",
        "np.eye(len(values), dtype=bool)",
        "tests/test_clusters.py::test_shapes_that_share_one_error_lie_below_what_each_says_alone",
    ),
    Mutation(
        "bounds: a gap inside a cluster is one to rest on",
        "solidgear/core/bounds/clusters.py",
        "lower_ends",
        "gap < BESIDE",
        "gap <= 0",
        "tests/test_clusters.py::test_nothing_beyond_a_cluster_leaves_no_lower_end",
    ),
    Mutation(
        "bounds: functions of the top order inside a cell are forgotten",
        "solidgear/core/bounds/patches.py",
        "_Loaded._eliminate",
        "_eliminated(stiffness, loads, const, top)",
        "reduced",
        "tests/test_bounds.py::test_the_space_of_an_order_less_is_that_of_a_mesh_an_order_lower",
    ),
    Mutation(
        "trains: the meshes of one shaft alone count",
        "solidgear/trains/assembly/mesh_errors.py",
        "mesh_errors",
        "np.sum([energies.two_more for energies in by_shaft.values()], axis=0)",
        "next(iter(by_shaft.values())).two_more",
        "tests/test_train_meshes.py::test_meshes_follow_until_every_mode_is_within_the_tolerance",
    ),
    Mutation(
        "bounds: what further orders would see is forgotten",
        "solidgear/core/bounds/harmonic.py",
        "with_tail",
        "two_more + (two_more - one_more) * ratio / (1 - ratio)",
        "two_more",
        "tests/test_bounds.py::test_orders_that_take_like_shares_are_summed_up_to_the_end",
    ),
    Mutation(
        "a coupling of a body has the bar of the middle of what is open",
        "solidgear/core/judge/bounded.py",
        "_between",
        "half + abs(middle - stiff[name])",
        "half",
        "tests/test_settle.py::test_bars_of_a_body_hold_its_own_couplings",
    ),
    Mutation(
        "a cell belongs to the place nearest to its middle, whatever it touches",
        "solidgear/core/judge/cell_places.py",
        "CellPlaces.owners",
        "np.where(touched.any(axis=0), sharpest, nearest)",
        "nearest",
        "tests/test_where_solid.py"
        "::test_a_cell_belongs_to_the_sharpest_place_it_touches_or_to_the_nearest_in_reach",
    ),
    Mutation(
        "a function gives all of its energy to each of its cells",
        "solidgear/core/bounds/solid.py",
        "_by_cells",
        "np.bincount(more.functions, work, minlength=len(count)) / np.maximum(count, 1)",
        "np.bincount(more.functions, work, minlength=len(count))",
        "tests/test_where_solid.py::test_energies_of_cells_are_all_of_the_energy",
    ),
    Mutation(
        "error bars know nothing of a mesh that is not the body",
        "solidgear/core/judge/bounded.py",
        "bounded",
        "bar.width + share",
        "bar.width",
        "tests/test_mesh_geometry.py::test_statics_have_all_of_it_and_frequencies_half",
    ),
    Mutation(
        "bounds of 3D solids: three steps, whatever is missing",
        "solidgear/core/bounds/solid.py",
        "_converged",
        "search.converged",
        "count == 2",
        "tests/test_bounds_solid.py::test_the_energy_is_that_of_solving_in_both_spaces_at_once",
    ),
    Mutation(
        "bounds of 3D solids: one order more finds all of the error",
        "solidgear/core/bounds/solid.py",
        "share_of_error",
        "share * SLOWER.get(element, 1.0)",
        "1.0",
        "tests/test_bounds_solid.py::test_bars_hold_and_are_hardly_wider_than_errors",
    ),
    Mutation(
        "bounds of 3D solids: the rim of a layer is seen as any other edge",
        "solidgear/core/bounds/layers.py",
        "Layers.added_share",
        "RIM * (2 * nu) ** 4",
        "0.0 * (2 * nu) ** 4",
        "tests/test_layers.py::test_bars_hold_on_even_meshes_of_others",
    ),
    Mutation(
        "bounds of 3D solids: all cells around an edge are of one material",
        "solidgear/core/models/solid/edges.py",
        "_Around.wedges",
        "self.materials[self.mesh.segment[cell]]",
        "self.materials[0]",
        "tests/test_mesh_edges.py::test_bars_hold_where_a_clamp_ends_at_a_joint",
    ),
    Mutation(
        "bounds of 3D solids: an edge does not know which face beside it is held",
        "solidgear/core/models/solid/edges.py",
        "sharp_edges",
        "is_held[held] = True",
        "is_held[held] = False",
        "tests/test_mesh_edges.py::test_what_is_held_ends_in_a_face_or_at_an_edge",
    ),
    Mutation(
        "bounds of 3D solids: few cells from face to face lock as little as the rest",
        "solidgear/core/bounds/layers.py",
        "Layers.refuse_locked",
        "share * _bulk(material.nu) > _bulk(LOCKING)",
        "share > 0.5",
        "tests/test_layers.py::test_a_few_cells_from_face_to_face_lock_a_layer_that_keeps_its_volume",
    ),
    Mutation(
        "bounds of 3D solids: bearings do not push a mode",
        "solidgear/core/bounds/solid.py",
        "errors_of_modes",
        "on_ports(block, left)",
        "0.0 * on_ports(block, left)",
        "tests/test_bounds_solid.py::test_bars_hold_and_are_hardly_wider_than_errors",
    ),
    Mutation(
        "bounds of 3D solids: the highest mode of a coarse mesh is believed",
        "solidgear/core/bounds/solid.py",
        "_lowest",
        "max(1 - off, 0.0)",
        "1.0",
        "tests/test_bars_of_a_mesh.py::test_a_mesh_of_the_fewest_cells_has_bars_that_hold",
    ),
    Mutation(
        "bounds of 3D solids: a mesh of another shaft is not refused",
        "solidgear/core/meshing/geometry.py",
        "refuse_misshapen",
        "worst.error > REFUSED",
        "False",
        "tests/test_mesh_geometry.py::test_a_mesh_far_from_the_shaft_is_refused",
    ),
    Mutation(
        "layers on straight sides",
        "solidgear/core/meshing/edge_layers.py",
        "_mapped",
        "4 * a[start] * a[end]",
        "0 * a[start] * a[end]",
        "tests/test_edge_layers.py::test_layers_fill_the_same_body[1]",
    ),
    Mutation(
        "faces of layers cut from any vertex",
        "solidgear/core/meshing/edge_layers.py",
        "Polyhedra.in_tetrahedra",
        "cells.corners[rows].argmin(axis=0)",
        "0 * cells.corners[0]",
        "tests/test_edge_layers.py::test_layers_fill_the_same_body[1]",
    ),
    Mutation(
        "segments are compared by volume alone",
        "solidgear/core/meshing/geometry.py",
        "misshapen",
        "eigh(of_mesh - of_shaft, of_shaft, eigvals_only=True)",
        "[of_mesh[0, 0] / of_shaft[0, 0] - 1]",
        "tests/test_mesh_geometry.py::test_bars_of_straight_elements_hold_on_both_sides",
    ),
    Mutation(
        "phase of the cut faces turned the other way",
        "solidgear/cuts/sector/cyclic.py",
        "basis",
        "1j * h * sector.angle",
        "-1j * h * sector.angle",
        "tests/test_sector.py::test_a_sector_is_the_whole[spiral]",
    ),
    Mutation(
        "the axis of a sector moves against the turn",
        "solidgear/cuts/sector/cyclic.py",
        "_across",
        "motion if np.allclose(turn @ motion, np.exp(-1j * angle) * motion) else motion.conj()",
        "motion.conj() if np.allclose(turn @ motion, np.exp(-1j * angle) * motion) else motion",
        "tests/test_sector.py::test_a_node_on_the_axis",
    ),
    Mutation(
        "energy of waves counted once a sector",
        "solidgear/cuts/sector/cyclic.py",
        "Wave.copies",
        "self.sector.count / 2",
        "self.sector.count / 1",
        "tests/test_sector.py::test_a_sector_is_the_whole[spiral]",
    ),
    Mutation(
        "ports of waves turned the other way",
        "solidgear/cuts/sector/cyclic.py",
        "Wave.motion",
        "p * turn",
        "p * turn.T",
        "tests/test_sector.py::test_a_sector_is_the_whole[spiral]",
    ),
    Mutation(
        "the cut face of half a sector moves against its phase",
        "solidgear/cuts/sector/half.py",
        "basis",
        "-sin * around",
        "sin * around",
        "tests/test_half_sector.py::test_half_a_sector_is_the_whole_one[teeth]",
    ),
    Mutation(
        "the other part of a tilt with the wrong sign",
        "solidgear/cuts/sector/half.py",
        "_in_parts",
        "(1.0, -1.0)",
        "(1.0, 1.0)",
        "tests/test_half_sector.py::test_half_a_sector_is_the_whole_one[teeth]",
    ),
    Mutation(
        "energy of half a sector counted once",
        "solidgear/cuts/sector/half.py",
        "_copies",
        "2 * half.count",
        "half.count",
        "tests/test_half_sector.py::test_half_a_sector_is_the_whole_one[teeth]",
    ),
    Mutation(
        "hand of a spiral turned",
        "solidgear/cuts/features/toothed.py",
        "Toothed.twist",
        "1 if self.hand == 'right' else -1",
        "-1 if self.hand == 'right' else 1",
        "tests/test_sector.py::test_a_right_hand_turns_about_y_along_y",
    ),
    Mutation(
        "spiral of a cylinder on a cone",
        "solidgear/cuts/sector/teeth.py",
        "turn_at",
        "hypot(1.0, slope)",
        "1.0",
        "tests/test_sector.py::test_a_right_hand_turns_about_y_along_y",
    ),
    Mutation(
        "Young's modulus 1 % high in the beam",
        "solidgear/core/models/beam/element.py",
        "Section.__init__",
        "self.bend = modulus * second",
        "self.bend = 1.01 * modulus * second",
        "tests/test_beam.py::test_uniform_cantilever",
    ),
    Mutation(
        "Young's modulus 1 % high in the harmonic solid",
        "solidgear/core/models/harmonic/blocks.py",
        "Work.block",
        "stiffness.add(part, law.reshape(c * c, k * k) @ gram)",
        "stiffness.add(part, 1.01 * law.reshape(c * c, k * k) @ gram)",
        "tests/test_harmonic.py::test_bending_wave_of_a_cylinder_between_sliding_ends",
    ),
    Mutation(
        "shoulder as soft in stretch as in bending",
        "solidgear/core/models/beam/shoulder.py",
        "hinges",
        "float(straight * stretch / (material.E * area))",
        "float(straight * bend / (material.E * area))",
        "tests/test_stability_models.py::test_a_beam_with_soft_shoulders_is_the_solid_under_a_moment_a_pull_and_a_twist",
    ),
    Mutation(
        "shear coefficient of a rectangle, 5/6",
        "solidgear/core/models/beam/element.py",
        "Section.__init__",
        "self.shear = factor * g * area",
        "self.shear = 5 / 6 * g * area",
        "tests/test_beam.py::test_free_free_timoshenko",
    ),
    Mutation(
        "shear stiffness with E for G",
        "solidgear/core/models/beam/element.py",
        "Section.__init__",
        "g = modulus / (2 * (1 + nu))",
        "g = modulus / 2",
        "tests/test_beam.py::test_free_free_rod",
    ),
    Mutation(
        "rotary inertia missing",
        "solidgear/core/models/beam/element.py",
        "bending_matrices",
        "c.rotary if rotary else none",
        "none",
        "tests/test_beam.py::test_free_free_timoshenko",
    ),
    Mutation(
        "lumped for consistent mass in the rod",
        "solidgear/core/models/beam/element.py",
        "rod_matrices",
        "m = shape.transpose(0, 2, 1) @ ((c.w * inertia)[..., None] * shape)",
        "m = ((c.w * inertia)[..., None] * shape).sum(axis=1)[:, None] * np.eye(2)",
        "tests/test_beam.py::test_free_free_rod",
    ),
    Mutation(
        "taper ignored: cone as the cylinder at its start",
        "solidgear/core/models/beam/element.py",
        "Section.__init__",
        "a = e.outer0[:, None] + t * (e.outer1 - e.outer0)[:, None]",
        "a = e.outer0[:, None] + 0 * t",
        "tests/test_beam.py::test_tapered_cantilever_against_the_unit_load_integral",
    ),
    Mutation(
        "sign of the tilt in the x plane",
        "solidgear/core/models/beam/body.py",
        "on_nodes",
        'bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0))',
        'bending.mirrored("bending_x", (0, 5), 0, (1.0, 1.0))',
        "tests/test_ports.py::test_ports_follow_rigid_motions",
    ),
    Mutation(
        "sign of a lever in the shift of a reference point",
        "solidgear/core/frames.py",
        "shift",
        "-cross_matrix(np.asarray(offset, float))",
        "cross_matrix(np.asarray(offset, float))",
        "tests/test_frames.py::test_shifted_motion_is_that_of_a_rigid_body",
    ),
    Mutation(
        "axis condition of bending dropped",
        "solidgear/core/models/harmonic/families.py",
        "Family.zero_on_axis",
        "(1, 2)",
        "(2,)",
        "tests/test_harmonic.py::test_bending_wave_of_a_cylinder_between_sliding_ends",
    ),
    Mutation(
        "one sign in the strain of the first harmonic",
        "solidgear/core/models/harmonic/families.py",
        "strains",
        "ty[2, 0], ty[2, 1], ty[0, 2] = -1.0, 1.0, -n",
        "ty[2, 0], ty[2, 1], ty[0, 2] = -1.0, 1.0, n",
        "tests/test_harmonic.py::test_bending_wave_of_a_cylinder_between_sliding_ends",
    ),
    Mutation(
        "mass of p and q taken like that of w",
        "solidgear/core/models/harmonic/families.py",
        "Family.share",
        "np.array([2.0, 2.0, 1.0])",
        "np.array([1.0, 1.0, 1.0])",
        "tests/test_harmonic.py::test_mass_matrix_of_shipped_scenes",
    ),
    Mutation(
        "torsion with r squared for r cubed",
        "solidgear/core/models/harmonic/families.py",
        "Family.power",
        "3 if self.waves == TORSION else 1",
        "2 if self.waves == TORSION else 1",
        "tests/test_harmonic.py::test_mass_matrix_of_shipped_scenes",
    ),
    Mutation(
        "Lame's lambda of plane stress",
        "solidgear/core/models/harmonic/families.py",
        "Family.stiffness",
        "lame = 2 * mu * material.nu / (1 - 2 * material.nu)",
        "lame = 2 * mu * material.nu / (1 - material.nu)",
        "tests/test_harmonic.py::test_bending_wave_of_a_cylinder_between_sliding_ends",
    ),
    Mutation(
        "seat mean without the weight of the radius",
        "solidgear/core/models/harmonic/families.py",
        "Family.means",
        "raw[..., 2, 1] = -np.pi * w * r * r",
        "raw[..., 2, 1] = -np.pi * w * r",
        "tests/test_ports.py::test_ports_follow_rigid_motions",
    ),
    Mutation(
        "sign of a rigid rotation of the solid",
        "solidgear/core/models/solid/block.py",
        "rigid_motions",
        "np.column_stack([zero, -z, y])",
        "np.column_stack([zero, z, y])",
        "tests/test_solid.py::test_rigid_motions_cost_no_energy",
    ),
    Mutation(
        "housing spring left out",
        "solidgear/core/body/supports.py",
        "as_supports",
        "(e @ ke + housing)",
        "(e @ ke + 1e30)",
        "tests/test_condense.py::test_axial_chain_of_bearings_and_housing",
    ),
    Mutation(
        "housing: seen from the origin, not from its own point",
        "solidgear/core/scene/housing.py",
        "Housing.moves",
        "y - self.y",
        "y",
        "tests/test_housing.py::test_against_a_dense_assembly",
    ),
    Mutation(
        "housing: half as soft as it is",
        "solidgear/core/springs.py",
        "in_series",
        "np.hypot(1.0, s)",
        "np.hypot(1.0, 0.5 * s)",
        "tests/test_housing.py::test_series_by_compliances",
    ),
    Mutation(
        "housing: springs in series the wrong way round",
        "solidgear/core/springs.py",
        "in_series",
        "1 / np.hypot(1.0, s)",
        "np.hypot(1.0, s)",
        "tests/test_housing.py::test_series_by_compliances",
    ),
    Mutation(
        "housing: seen at the place of the other bearing",
        "solidgear/core/body/supports.py",
        "as_supports",
        "[b.y for b in bearings]",
        "[b.y for b in bearings[::-1]]",
        "tests/test_housing.py::test_against_a_dense_assembly",
    ),
    Mutation(
        "sweep: the housing of the other bearing",
        "solidgear/core/scene/sprung.py",
        "resprung",
        '_bearing(bearings[k], tables["bearing"][k])',
        '_bearing(bearings[k], tables["bearing"][0])',
        "tests/test_housing.py::test_a_sweep_over_what_one_bearing_stands_in",
    ),
    Mutation(
        "two points: the block between them transposed",
        "solidgear/core/solve/condensed.py",
        "Coupled.between",
        "np.ix_(a, b)",
        "np.ix_(b, a)",
        "tests/test_points.py::test_cantilever",
    ),
    Mutation(
        "two points: a term between them related to itself",
        "solidgear/core/quantity.py",
        "Quantity.diagonals",
        "not self.is_coupling and (pair is None or pair[0] == pair[1])",
        "True",
        "tests/test_point_bars.py::test_a_term_that_symmetry_forbids_has_a_bar",
    ),
    Mutation(
        "two points: stiffness as sure as the compliance it is inverted from",
        "solidgear/core/judge/solving.py",
        "_solver_errors",
        "inverted.evidence['stiffness_error']",
        "inverted.evidence['residual']",
        "tests/test_point_bars.py::test_stiffness_between_points_carries_what_its_inverse_loses",
    ),
    Mutation(
        "two points: the springs between them left out",
        "solidgear/core/solve/statics.py",
        "_full_compliance",
        "f_ll - reach.T @ reach + swing.T @ swing",
        "f_ll + swing.T @ swing",
        "tests/test_points.py::test_simply_supported_beam",
    ),
    Mutation(
        "sign of a bearing's coupling",
        "solidgear/core/body/supports.py",
        "as_supports",
        "k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = bearing.stiffness",
        "k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = bearing.stiffness * np.where(np.eye(6) > 0, 1, -1)",
        "tests/test_condense.py::test_against_a_direct_dense_solution",
    ),
    Mutation(
        "series spring beside the bearing instead of behind it",
        "solidgear/core/scene/stations.py",
        "Bearing.stiffness",
        "K -= np.outer(K[:, 1], K[1, :]) / (K[1, 1] + spring)",
        "K[1, 1] += spring",
        "tests/test_scene.py::test_series_spring_condenses_the_couplings_of_y",
    ),
    Mutation(
        "lumped point 1 mm off",
        "solidgear/core/scene/places.py",
        "Places.enter",
        "(lo + hi) / 2",
        "(lo + hi) / 2 + 1e-3",
        "tests/test_scene.py::test_overhung_pinion_against_closed_forms",
    ),
    Mutation(
        "shift not refined away in statics",
        "solidgear/core/solve/inertia_relief.py",
        "elastic_fields",
        "missing < tolerance or share > 0.5 * last",
        "True",
        "tests/test_condense.py::test_against_a_direct_dense_solution",
    ),
    Mutation(
        "rigid motions of the load port forgotten",
        "solidgear/core/solve/statics.py",
        "_full_compliance",
        "x = (p_l @ resisted - reach.T @ rigid).T",
        "x = (p_l @ resisted).T",
        "tests/test_condense.py::test_against_a_direct_dense_solution",
    ),
    Mutation(
        "springs forgotten in the energy of a mode",
        "solidgear/core/solve/refine.py",
        "_modes",
        "value = (columns(elastic, pull) + columns(stretch, stretch)) / columns(u, heavy)",
        "value = columns(elastic, pull) / columns(u, heavy)",
        "tests/test_modes.py::test_against_dense_eigenvalues",
    ),
    Mutation(
        "springs missing from the modes",
        "solidgear/core/solve/supported.py",
        "Supported._quick_inverse",
        "y = y - self._through @ self._inner(self.load.T @ y)",
        "pass",
        "tests/test_modes.py::test_against_dense_eigenvalues",
    ),
    Mutation(
        "a mode dropped by the eigensolver",
        "solidgear/core/solve/eigen.py",
        "lowest",
        "enumerate(refined.value)",
        "((i, v) for i, v in enumerate(refined.value) if i != 1)",
        "tests/test_modes.py::test_against_dense_eigenvalues",
    ),
    Mutation(
        "Lame's lambda of plane stress in the 3D solid",
        "solidgear/core/models/solid/matrices.py",
        "integrals",
        "lame = 2 * mu * nu / (1 - 2 * nu)",
        "lame = 2 * mu * nu / (1 - nu)",
        "tests/test_solid.py::test_light_hexahedra_bend_near_the_reference",
    ),
    Mutation(
        "flexibility one per cent high",
        "solidgear/core/solve/statics.py",
        "port_fields",
        "work + work.T - u.T @ (k @ u)",
        "1.01 * work",
        "tests/test_condense.py::test_against_a_direct_dense_solution",
    ),
    Mutation(
        "inertia of the bearings left out of the count",
        "solidgear/core/solve/eigen.py",
        "count_below",
        "negative += int((np.linalg.eigvalsh(inner) < 0).sum()) - springs",
        "pass",
        "tests/test_eigen.py::test_count_confirms_complete_results",
    ),
    Mutation(
        "sign of a lumped mass in the exact beam",
        "validation/thesis/krylov.py",
        "_Joint.act",
        "b[2:] - self.mass[:, None, None] * omega**2 * b[:2]",
        "b[2:] + self.mass[:, None, None] * omega**2 * b[:2]",
        "tests/test_krylov.py::test_overhung_shaft_of_the_thesis",
    ),
    Mutation(
        "Guyan mass on compliance shapes instead of unit motions",
        "solidgear/core/reduction/lumped_point.py",
        "_guyan",
        "shapes = fields @ np.linalg.inv(compliance)",
        "shapes = fields @ np.diag(1 / np.diag(compliance))",
        "tests/test_effective_mass.py::test_guyan_of_a_nearly_rigid_shaft_is_the_rigid_body",
    ),
    Mutation(
        "hand of the spiral swapped",
        "solidgear/core/system/gear_mesh.py",
        "line_of_action",
        's = _SPIRAL[_word("hand", hand, _SPIRAL)]',
        's = -_SPIRAL[_word("hand", hand, _SPIRAL)]',
        "tests/test_gear_mesh.py::test_components_are_the_textbook_ones",
    ),
    Mutation(
        "sliding left out of the relative curvature of bevel flanks",
        "solidgear/teeth/bevel/flank.py",
        "BevelFlanks.points",
        "1 - cot_pinion * slide",
        "1 - 0 * slide",
        "tests/test_bevel_flanks.py::test_the_relative_curvature_is_that_of_real_flanks[concave]",
    ),
    Mutation(
        "tips of bevel gears as a rack has them",
        "solidgear/teeth/bevel/flank.py",
        "BevelFlanks._lift",
        "self.blank.mean_distance * np.tan(angle - self.blank.pitch_angles[member])",
        "point[..., 2] * (-1) ** (member + 1)",
        "tests/test_bevel_flanks.py::"
        "test_straight_narrow_teeth_have_the_contact_ratio_of_their_virtual_spur_wheels",
    ),
    Mutation(
        "neighbours of bevel teeth taken the wrong way round",
        "solidgear/teeth/bevel/pair.py",
        "BevelPair.bulk",
        "(1, -1)",
        "(1, 1)",
        "tests/test_bevel_pair.py::"
        "test_on_both_wheels_the_next_tooth_clockwise_touches_nearer_to_the_tip[concave-left]",
    ),
    Mutation(
        "corners of tips as wide as flanks with the same load",
        "solidgear/teeth/contact/local.py",
        "LineContact._widths",
        "wide / 2 * np.exp((share - 1) / 2)",
        "width",
        "tests/test_teeth_contact.py::"
        "test_corner_law_is_that_of_the_pressure_between_half_planes[0.001]",
    ),
    Mutation(
        "relieved flanks that do not lean at corners of tips",
        "solidgear/teeth/contact/cylindrical.py",
        "CylindricalPair.least_gap",
        "lean * np.abs(beside)",
        "0 * np.abs(beside)",
        "tests/test_teeth_contact.py::test_relieved_flanks_touch_beside_the_line_of_action[0.002]",
    ),
    Mutation(
        "relieved flanks that touch on the line of action alone",
        "solidgear/teeth/contact/cylindrical.py",
        "CylindricalPair.least_gap",
        "gap.min(axis=1)",
        "gap[:, BESIDE // 2]",
        "tests/test_teeth_contact.py::test_relieved_flanks_touch_beside_the_line_of_action[None]",
    ),
    Mutation(
        "the norm's mesh stiffness by the mean of both moduli",
        "solidgear/core/gears/norm.py",
        "material_factor",
        "2 * first * second / (first + second)",
        "(first + second) / 2",
        "tests/test_teeth_contact.py::test_stiffness_by_the_norm_is_that_of_the_material",
    ),
    Mutation(
        "a rim that is held at its bore",
        "solidgear/teeth/train_teeth.py",
        "TeethModel.compliance",
        "bore is not None",
        "False",
        "tests/test_teeth_train.py::test_thinner_rims_are_softer",
    ),
    Mutation(
        "a floating sun goes where one of its planets pushes it",
        "solidgear/teeth/supports.py",
        "Carried._alike",
        "m.mate == mesh.mate and m.name != mesh.name",
        "False",
        "tests/test_face_load.py::"
        "test_a_floating_sun_has_the_face_load_factors_of_springs_along_every_face",
    ),
    Mutation(
        "flanks: a helix slope turns with the flank that carries",
        "solidgear/trains/file/mesh_teeth.py",
        "_mesh_teeth",
        "along[k] * flanks.helix_slope",
        "flanks.helix_slope",
        "tests/test_mesh_teeth.py::"
        "test_a_slope_is_missing_at_the_end_of_the_shaft_whatever_flank_carries",
    ),
    Mutation(
        "flanks: face places run the other way on the other hand",
        "solidgear/trains/file/mesh_teeth.py",
        "_way",
        "(hand == flank) != coast",
        "hand == flank",
        "tests/test_mesh_teeth.py::"
        "test_face_places_run_the_way_in_which_a_line_nears_the_first_tips",
    ),
    Mutation(
        "flanks: more material is a gap",
        "solidgear/trains/file/flanks.py",
        "MeasuredFlank.grid",
        "tuple((-value for value in row))",
        "tuple(row)",
        "tests/test_mesh_teeth.py::test_a_measured_grid_is_turned_round_with_the_face",
    ),
    Mutation(
        "flanks: long relief of the second wheel begins where that of the first does",
        "solidgear/trains/file/mesh_teeth.py",
        "_single_contact",
        "wheels.second_length(start + overlap)",
        "wheels.second_length(stop - overlap)",
        "tests/test_mesh_teeth.py::test_long_relief_begins_where_a_single_pair_carries",
    ),
    Mutation(
        "teeth: a ring has the backlash of an outer wheel",
        "solidgear/core/gears/wheel_pair.py",
        "WheelPair.backlash",
        "at_base * cos(self.base_helix)",
        "self.second.sign * at_base * cos(self.base_helix)",
        "tests/test_gear_wheels.py::test_a_planet_nearer_to_its_ring_has_less_backlash",
    ),
    Mutation(
        "nonlinear: solved teeth are as stiff all over their cycle",
        "solidgear/backlash/nonlinear.py",
        "_over_cycle",
        "assembly.with_train(assembly.teeth.over_cycle(asked.point, driver.name))",
        "assembly",
        "tests/test_settled_state.py::test_solved_teeth_vary_over_their_cycle_with_backlash",
    ),
    Mutation(
        "nonlinear: modes that higher orders meet are springs",
        "solidgear/backlash/train.py",
        "with_backlash",
        "highest * _highest_order(assembly, teeth)",
        "highest",
        "tests/test_settled_state.py::test_modes_that_higher_orders_meet_move_as_well",
    ),
    Mutation(
        "bearing: loads and lives rest on another model than deflection trusts",
        "solidgear/trains/load/operation.py",
        "Operating.__init__",
        "assembly.at_ports(), assembly.solids",
        'assembly.settling("timoshenko"), ("timoshenko",)',
        "tests/test_agree.py::test_bearings_have_one_load_and_one_life_by_every_command",
    ),
    Mutation(
        "teeth: bearings settle with the force at the middle of the face",
        "solidgear/trains/load/operation.py",
        "Operating._at",
        "self.assembly.at(point, self.choice)",
        "self.assembly.on_flank(point.coast)",
        "tests/test_settled_state.py::test_bearings_are_as_stiff_as_at_the_loads_that_deflect_shows",
    ),
    Mutation(
        "teeth: rows of a sweep settle from the rows before them",
        "solidgear/variants/sweep/tooth_numbers.py",
        "TeethBench.carried",
        "operating.at(point)",
        "operating.at(point, self._states[0][1].state if self._states else None)",
        "tests/test_teeth_design.py::test_no_row_depends_on_the_rows_before_it",
    ),
    Mutation(
        "teeth: rows of a sweep keep the load of another torque",
        "solidgear/variants/sweep/tooth_numbers.py",
        "TeethBench.carried",
        "settled_at == point",
        "True",
        "tests/test_teeth_design.py::test_a_row_is_the_contact_of_the_file_edited_by_hand",
    ),
    Mutation(
        "teeth: relief that opens the flanks less than it is deep",
        "solidgear/teeth/contact/cylindrical.py",
        "CylindricalPair.least_gap",
        "shape.deviation(moved, z[:, None])",
        "0.9 * shape.deviation(moved, z[:, None])",
        "tests/test_teeth_design.py::test_long_relief_against_a_contact_program_of_sectors[10]",
    ),
    Mutation(
        "teeth: a search that takes the best of its operating points",
        "solidgear/variants/optimise/wish.py",
        "Wish.value",
        "min if self.upward else max",
        "max if self.upward else min",
        "tests/test_teeth_design.py::test_the_worst_of_several_rows_counts",
    ),
    Mutation(
        "planetary: teeth of a ring lean like those of a sun",
        "solidgear/core/system/gear_mesh.py",
        "cylindrical_mesh",
        "leans = -pressure_angle if internal else pressure_angle",
        "leans = pressure_angle",
        "tests/test_planetary.py::test_an_internal_mesh_pushes_the_mate_inwards_and_turns_both_alike",
    ),
    Mutation(
        "planetary: a planet turns in a ring as on a sun",
        "solidgear/core/system/gear_mesh.py",
        "cylindrical_mesh",
        "mate_pitch = mate_radius if internal else -mate_radius",
        "mate_pitch = -mate_radius",
        "tests/test_planetary.py::test_three_planets_have_the_published_frequencies_to_every_digit",
    ),
    Mutation(
        "planetary: a ring that stands still pulls its planets",
        "solidgear/trains/system/planetary.py",
        "PlanetaryStage.joints",
        "RowSpring(centre, -planet_rows, stiffness)",
        "RowSpring(centre, planet_rows, stiffness)",
        "tests/test_train_planetary.py::"
        "test_equal_planets_on_a_train_that_holds_the_sun_share_equally_and_torques_balance",
    ),
    Mutation(
        "planetary: teeth of a sun that is driven back touch by the same flank",
        "solidgear/trains/assembly/stages.py",
        "StageAtWork.axes",
        "np.diag([1.0, self.way, self.way])",
        "np.eye(3)",
        "tests/test_train_planetary.py::"
        "test_teeth_of_planets_push_by_the_other_flank_where_the_sun_is_driven_back",
    ),
    Mutation(
        "planetary: a ring pushes its housing beside the place where it stands",
        "solidgear/trains/assembly/stages.py",
        "stages_at_work",
        "point - centre",
        "point",
        "tests/test_train_joined.py::"
        "test_a_ring_stands_in_the_housing_whose_mounts_carry_its_torque",
    ),
    Mutation(
        "planetary: errors of all planets come at once",
        "solidgear/trains/file/planetary.py",
        "PlanetMesh.phases",
        "way * teeth.sun * teeth.azimuths[k - 1]",
        "0.0",
        "tests/test_train_planetary.py::"
        "test_phases_of_planets_let_a_mesh_turn_the_shafts_or_shift_them",
    ),
    Mutation(
        "planetary: a sun rests where its planets have pushed it",
        "solidgear/trains/assembly/turn.py",
        "_support",
        "state.motion(end)[HELD] - compliance @ pushed[HELD]",
        "state.motion(end)[HELD]",
        "tests/test_train_planetary.py::"
        "test_over_a_turn_of_its_carrier_the_reducer_is_what_it_is_at_rest_at_every_position",
    ),
    Mutation(
        "planetary: planets lie in the axes of the carrier",
        "solidgear/trains/system/planetary.py",
        "PlanetaryStage.parts",
        "Placed(body_of(planet, {}), planet.axes, pins[name])",
        "Placed(body_of(planet, {}), np.eye(3), pins[name])",
        "tests/test_planetary.py::test_three_planets_have_the_published_frequencies_to_every_digit",
    ),
    Mutation(
        "planetary: a pin carries one of its two tooth forces",
        "solidgear/trains/system/planetary.py",
        "PlanetaryStage.path_stiffness",
        "self.meshes(k).values()",
        "[self.meshes(k)['sun']]",
        "tests/test_carrier_turn.py::test_a_shifted_support_modulates_every_mesh_at_the_carrier_frequency",
    ),
    Mutation(
        "planetary: a shift turns with the carrier",
        "solidgear/trains/system/carrier_turn.py",
        "_loads_beyond_mean",
        "fixed.matrix @ fixed.off",
        "np.einsum('ij,ajk,k->ai', fixed.matrix, turns, fixed.off)",
        "tests/test_carrier_turn.py::test_a_shifted_support_modulates_every_mesh_at_the_carrier_frequency",
    ),
    Mutation(
        "planetary: a support turns with the carrier",
        "solidgear/trains/system/carrier_turn.py",
        "_loads_beyond_mean",
        "turns.transpose(0, 2, 1)",
        "np.broadcast_to(np.eye(6), turns.shape)",
        "tests/test_carrier_turn.py::test_a_support_of_two_stiffnesses_is_that_of_a_stage_built_at_every_position",
    ),
    Mutation(
        "planetary: a late pin unloads its planet",
        "solidgear/trains/system/carrier_turn.py",
        "_gaps",
        "-root_of(planet.support).T @ error_motion",
        "root_of(planet.support).T @ error_motion",
        "tests/test_carrier_turn.py::test_errors_share_out_as_rank_says",
    ),
    Mutation(
        "planetary: a ring has the hand of its sun",
        "solidgear/trains/system/planetary.py",
        "PlanetaryStage.meshes",
        "hand = -self.base_helix if internal else self.base_helix",
        "hand = self.base_helix",
        "tests/test_planetary_space.py::test_a_planet_between_helical_meshes_is_tilted_but_not_pushed_along_its_axis",
    ),
    Mutation(
        "planetary: a right-handed tooth pushes as a left-handed one",
        "solidgear/core/system/gear_mesh.py",
        "cylindrical_mesh",
        "-sin(base_helix)",
        "sin(base_helix)",
        "tests/test_planetary_space.py::test_helical_teeth_push_as_the_textbook_has_it",
    ),
    Mutation(
        "planetary: the face tilts as if all teeth were at its ends",
        "solidgear/trains/system/planetary.py",
        "PlanetaryStage._rows",
        "offset = self.face_width / sqrt(12)",
        "offset = self.face_width / 2",
        "tests/test_planetary_space.py::test_helical_stages_are_those_of_an_assembly_by_points_and_modes_come_as_symmetry_says",
    ),
    Mutation(
        "planetary: half a Coriolis force",
        "solidgear/trains/system/planetary.py",
        "turning_terms",
        "2 * about * body.mass",
        "about * body.mass",
        "tests/test_planetary_turning.py::test_modes_in_turning_axes_are_motions_in_space",
    ),
    Mutation(
        "planetary: members that tilt are no gyroscopes",
        "solidgear/trains/system/planetary.py",
        "turning_terms",
        "2 * across - polar",
        "2 * across",
        "tests/test_planetary_turning.py::test_a_sun_that_vibrates_in_space_is_seen_a_turn_faster_and_slower",
    ),
    Mutation(
        "planetary: planets pull where they were",
        "solidgear/trains/system/planetary.py",
        "turning_terms",
        "turned = -force * relative.T @ cross_matrix(outward) @ carried[3:]",
        "turned = 0 * system.mass",
        "tests/test_planetary_turning.py::test_a_free_stage_stays_free_for_its_planets_pull_turns_with_it",
    ),
    Mutation(
        "planetary: a ring is pushed on a quarter turn from its planets",
        "solidgear/bearings/elastic_ring.py",
        "elastic_ring",
        "azimuth + np.pi / 2",
        "azimuth",
        "tests/test_elastic_ring.py::test_a_stage_with_a_thin_ring_is_that_of_plane_sections",
    ),
    Mutation(
        "bearing: the contact angle of a ball does not turn",
        "solidgear/bearings/ball.py",
        "BallRow.tangent",
        "turning = self.constant * approach * root / length",
        "turning = 0.0 * approach",
        "tests/test_bearings_rows.py::test_tangent_equals_differences_over_random_loads",
    ),
    Mutation(
        "bearing: slices of a roller have no lever",
        "solidgear/bearings/roller.py",
        "RollerRow._normal",
        "height = self.height + self.along * c",
        "height = self.height + 0.0 * self.along",
        "tests/test_manual.py::test_case[roller_row-A]",
    ),
    Mutation(
        "bearing: a tilt about z moves the wrong way",
        "solidgear/bearings/row.py",
        "felt",
        "axial = np.stack([zero, zero + 1.0, zero, -radius * s, radius * c], axis=-1)",
        "axial = np.stack([zero, zero + 1.0, zero, -radius * s, -radius * c], axis=-1)",
        "tests/test_bearings_rows.py::test_tangent_is_the_derivative_of_a_load_written_anew",
    ),
    Mutation(
        "bearing: half of the clearance at work",
        "solidgear/bearings/ball.py",
        "BallRow.start",
        "radial = self.free * np.cos(self.angle) - self.clearance / 2",
        "radial = self.free * np.cos(self.angle) - self.clearance / 4",
        "tests/test_manual.py::test_case[ball_bearing_displacement-A]",
    ),
    Mutation(
        "bearing: gyroscopic moment does not follow the angle",
        "solidgear/bearings/spinning.py",
        "SpinningBalls._inertia",
        "turn_a = factor * (orbit_a * tan + orbit * tan_a) / p - turn * p_a / p",
        "turn_a = factor * orbit_a * tan / p",
        "tests/test_bearings_catalogue.py::test_tangent_at_speed_is_exact",
    ),
    Mutation(
        "bearing: the housing's spring is left out of the equilibrium",
        "solidgear/bearings/balance.py",
        "Balance.__init__",
        "self.reads[k][:, column : column + len(foot.stiffness)] = -foot.moves",
        "self.reads[k][:, column : column + len(foot.stiffness)] = -0.0 * foot.moves",
        "tests/test_bearings_equilibrium.py::test_series_spring_and_housing_take_the_bearings_load",
    ),
    Mutation(
        "operating point: the gear is pushed the way the pinion is",
        "solidgear/trains/assembly/layout.py",
        "force_on",
        "-contact.gear.vector",
        "contact.gear.vector",
        "tests/test_train_operation.py::test_every_shaft_is_in_balance",
    ),
    Mutation(
        "operating point: a coasting torque pulls at the driving flank",
        "solidgear/trains/load/contact.py",
        "other_flank",
        "2 * (normal @ across) * across - normal",
        "-normal",
        "tests/test_train_operation.py::test_a_negative_torque_is_carried_by_the_other_flank",
    ),
    Mutation(
        "housing of a train: its products of inertia are left out",
        "solidgear/trains/file/housing.py",
        "TrainHousing.mass_matrix",
        "out[3:, 3:] = self.inertia",
        "out[3:, 3:] = np.diag(np.diag(self.inertia))",
        "tests/test_train_housing.py::test_rigid_shafts_and_their_housing_move_like_matrices_written_by_hand",
    ),
    Mutation(
        "housing of a train: its bearings settle against ground",
        "solidgear/trains/system/equilibrium.py",
        "OnBearings._seat_motions",
        "relative_motion(self.system.port(end), *base)",
        "self.system.port(end).rows",
        "tests/test_train_housing.py::test_mounts_carry_the_difference_of_both_torques_and_the_weight",
    ),
    Mutation(
        "housing of a train: its bearings push back as if it stood still",
        "solidgear/trains/assembly/housing.py",
        "seat_motion",
        "[system.port(port)] if port is not None else []",
        "[]",
        "tests/test_train_housing.py::test_what_bearings_mounts_and_inertia_do_to_a_housing_is_in_balance_at_every_frequency",
    ),
    Mutation(
        "equilibrium of a system: what the load bends is left out at the seats",
        "solidgear/trains/system/equilibrium.py",
        "OnBearings.equilibrium",
        "pushed - self._soft @ (self._soft.T @ rigid)",
        "0.0 * pushed",
        "tests/test_train_operation.py::test_deflection_of_a_stepped_shaft_is_that_of_castigliano",
    ),
    Mutation(
        "harmonic balance: what lies between two instants at a kink has the wrong sign",
        "solidgear/backlash/solver/balance.py",
        "Balance._parts",
        "kink.jump / 4",
        "-kink.jump / 4",
        "tests/test_nonlinear_pair.py::test_three_motions_live_at_one_speed",
    ),
    Mutation(
        "impact: what leaves is held back",
        "solidgear/core/system/law.py",
        "Gap.force",
        "side * value > 0",
        "side * value > -np.inf",
        "tests/test_reducer_dynamics.py::test_what_leaves_is_never_held_back",
    ),
    Mutation(
        "harmonic balance: sidebands move at the mesh frequency",
        "solidgear/backlash/solver/two_tone.py",
        "TwoTone.frequencies",
        "np.array(self.pairs) @ np.array(self.omega)",
        "np.array(self.pairs)[:, 0] * self.omega[0]",
        "tests/test_reducer_dynamics.py::test_two_tones_on_a_linear_system_are_its_response_at_either",
    ),
    Mutation(
        "motion in time: a tooth that touches pushes back a little less",
        "solidgear/backlash/solver/pieces.py",
        "Pieces._piece",
        "push[:, 2 * r] -= f",
        "push[:, 2 * r] -= 0.98 * f",
        "tests/test_nonlinear_pair.py"
        "::test_sweeps_in_time_follow_the_branch_and_jump_where_it_turns",
    ),
    Mutation(
        "a line of action turns the other way round over the mesh cycle",
        "solidgear/backlash/solver/sway.py",
        "Sway.line",
        "(turn @ self.orders).real",
        "(turn.conj() @ self.orders).real",
        "tests/test_nonlinear_line.py"
        "::test_teeth_whose_line_turns_move_as_the_equations_written_out",
    ),
    Mutation(
        "run-up: the angle of the excitation is that of the speed of the moment all along",
        "solidgear/backlash/solver/motion.py",
        "Run.__init__",
        "middle * (omega + self.speeds) / 2",
        "middle * self.speeds",
        "tests/test_nonlinear_run_up.py::test_a_linear_run_is_that_of_the_closed_form",
    ),
    Mutation(
        "Floquet: where damping sets in, small motions leap the other way",
        "solidgear/backlash/solver/stability.py",
        "_saltation",
        "-remainder.shapes.T @ jump @ rate",
        "remainder.shapes.T @ jump @ rate",
        "tests/test_nonlinear_pair.py::test_multipliers_are_how_a_disturbed_motion_fades",
    ),
    Mutation(
        "remainder: a transmission error is no stretch of the teeth",
        "solidgear/backlash/solver/model.py",
        "Remainder.linear",
        "(h @ push[..., None])[..., 0] + e @ self.stiffness @ self.flexible - e",
        "(h @ push[..., None])[..., 0] + e @ self.stiffness @ self.flexible",
        "tests/test_nonlinear_pair.py::test_a_motion_that_keeps_contact_is_the_linear_one",
    ),
    Mutation(
        "remainder: a mode has its loss factor as damping ratio",
        "solidgear/backlash/solver/model.py",
        "remainder",
        "np.diag(np.diag(lost_energy)[moving] / omega)",
        "np.diag(2 * np.diag(lost_energy)[moving] / omega)",
        "tests/test_train_nonlinear.py::test_the_linear_peak_hides_where_teeth_part_and_jump",
    ),
    Mutation(
        "branches: the balance is taken for the same at all speeds",
        "solidgear/backlash/solver/continuation.py",
        "Follower.bordered",
        "residual.by_omega * self.width / self.size",
        "0.0 * residual.by_omega",
        "tests/test_nonlinear_pair.py::test_a_branch_turns_where_it_jumps",
    ),
    Mutation(
        "branches: more harmonics are asked for at the same speed alone",
        "solidgear/backlash/solver/continuation.py",
        "Follower.refit",
        "self.correct(near, 0.0)",
        "None",
        "tests/test_train_nonlinear.py::test_a_branch_takes_up_harmonics_beside_its_turning_point",
    ),
    Mutation(
        "period doubling: the excitation of one period is that of two",
        "solidgear/backlash/solver/apart.py",
        "_doubled_branch",
        "begin.balance.remainder.slower(2)",
        "begin.balance.remainder.slower(1)",
        "tests/test_nonlinear_pair.py"
        "::test_where_a_period_doubles_a_branch_of_two_periods_begins_that_time_confirms",
    ),
    Mutation(
        "Hill: a motion of two cycles has whole orders",
        "solidgear/backlash/solver/varying.py",
        "hill",
        "0.5 if half else 0.0",
        "0.0",
        "tests/test_nonlinear_varying.py::test_tongues_of_mathieu_by_hill_and_by_floquet",
    ),
    Mutation(
        "motion in time: the stiffness of straight pieces stands still",
        "solidgear/backlash/solver/integrated.py",
        "Integrated._straight_slope",
        "1 + around[b:c]",
        "1 + 0.0 * around[b:c]",
        "tests/test_nonlinear_varying.py::test_balance_and_time_agree_on_every_law",
    ),
    Mutation(
        "motion in time: the stiffness of curved laws stands still",
        "solidgear/backlash/solver/integrated.py",
        "Integrated._stretches",
        "self.angle(t)",
        "0.0 * self.angle(t)",
        "tests/test_nonlinear_varying.py::test_balance_and_time_agree_on_every_law",
    ),
    Mutation(
        "misalignment: the gear's own tilt is left out",
        "solidgear/strength/deflection/misalignment.py",
        "_parallel",
        "(first - second)",
        "(first - 0.0 * second)",
        "tests/test_train_operation.py::test_misalignment_of_parallel_shafts_is_that_of_both",
    ),
    Mutation(
        "transmission error added to the stretch of the teeth",
        "solidgear/trains/response/drive.py",
        "Drive._teeth",
        "factor * (dte - error)",
        "factor * (dte + error)",
        "tests/test_train_response.py::test_the_reduced_response_is_that_of_the_full_matrices",
    ),
    Mutation(
        "bearing reactions from the diagonal alone",
        "solidgear/trains/response/drive.py",
        "Drive._reaction_rows",
        "force = -np.array(supports.stiffness) @ seats",
        "force = -np.diag(np.diag(supports.stiffness)) @ seats",
        "tests/test_train_response.py::test_the_reduced_response_is_that_of_the_full_matrices",
    ),
    Mutation(
        "receptance as a sum over modes",
        "solidgear/trains/response/receptance.py",
        "receptance",
        "drive.steady.solved(hz, drive.load, row[None])[:, 0]",
        "drive.motion(hz, row[None])[:, 0]",
        "tests/test_train_receptance.py::test_the_reduced_receptance_is_that_of_the_full_matrices",
    ),
    Mutation(
        "teeth lose no more than the rest",
        "solidgear/core/system/common_loss.py",
        "in_real_modes",
        "lost = 1j * common.difference",
        "lost = 0j * common.difference",
        "tests/test_train_sets.py::test_losses_in_real_modes_are_those_of_the_full_matrices",
    ),
    Mutation(
        "the gear drawn where the pinion is",
        "solidgear/trains/modes/pictures.py",
        "system_surface",
        "drawn.points @ turn.T + origin",
        "drawn.points @ turn.T",
        "tests/test_train_pictures.py::test_as_the_train_turns_its_teeth_stay_together",
    ),
    Mutation(
        "orders of the gear at the speed of the pinion",
        "solidgear/trains/assembly/orders.py",
        "order_map",
        "train.turns.items()",
        "dict.fromkeys(train.turns, 1.0).items()",
        "tests/test_train_orders.py::test_an_order_meets_a_mode_where_teeth_and_speed_say",
    ),
    Mutation(
        "a mesh about the corner turns the first of its shafts alone",
        "solidgear/trains/load/contact.py",
        "axes_of",
        'parallel or side == "pinion"',
        'side == "pinion"',
        "tests/test_train_many.py::test_rigid_shafts_move_like_matrices_written_by_hand",
    ),
    Mutation(
        "torque passes a shaft as if both of its gears had one radius",
        "solidgear/trains/assembly/layout.py",
        "mesh_forces",
        "torque_on(joint, side, mesh_contacts) * turns[side]",
        "torque_on(joint, side, mesh_contacts)",
        "tests/test_train_many.py"
        "::test_forces_at_rest_are_in_balance_on_every_shaft_and_torque_leaves_by_the_teeth",
    ),
    Mutation(
        "all of the power passes a mesh that a load before it has taken some of",
        "solidgear/trains/file/power.py",
        "flows_of",
        "flow * (abs(flow) > NONE)",
        "(flow > NONE) - (flow < -NONE)",
        "tests/test_train_power.py::test_a_torque_divides_by_the_shares_of_the_power",
    ),
    Mutation(
        "teeth of a gear take no space beyond its pitch circle",
        "solidgear/trains/assembly/space.py",
        "_gear",
        "radius + module * (1 + wheel.profile_shift)",
        "radius",
        "tests/test_train_space.py::test_a_wheel_turned_into_the_first_shaft_is_told_by_how_much",
    ),
    Mutation(
        "no grid points at the poles",
        "solidgear/core/system/steady.py",
        "SteadyState.grid",
        "width[near, None] * AROUND",
        "width[near, None] * 1e9",
        "tests/test_train_response.py::test_no_peak_is_missed_between_two_grid_points",
    ),
    Mutation(
        "bearings 1 % stiff in the condensed shaft",
        "solidgear/core/reduction/condensed.py",
        "condensed_shaft",
        "np.diag(elastic.astype(float)) + seats.T @ supports @ seats",
        "np.diag(elastic.astype(float)) + 1.01 * seats.T @ supports @ seats",
        "tests/test_train_models.py::test_a_lumped_shaft_has_the_condensed_stiffness",
    ),
    Mutation(
        "central axis of contact cells on the wrong side",
        "solidgear/core/system/contact_cells.py",
        "ContactWrench.point",
        "np.cross(self.force, self.moment)",
        "np.cross(self.moment, self.force)",
        "tests/test_train_scene.py::test_a_wrench_leaves_its_pitch_and_nothing_else",
    ),
    Mutation(
        "fillets: shear counts with the wrong sign in one plane",
        "solidgear/strength/stress/shaft.py",
        "local_stress",
        "((-m_x, q_z), (m_z, q_x))",
        "((-m_x, q_z), (-m_z, q_x))",
        "tests/test_fillet_stress.py::test_amplitude_does_not_depend_on_the_direction_of_the_load",
    ),
    Mutation(
        "fillets: the unit of shear bends the fillet too",
        "solidgear/strength/stress/notch.py",
        "_profiles",
        "place - end",
        "0.0",
        "tests/test_fillet_stress.py::test_the_piece_has_the_stress_of_the_whole_shaft[False]",
    ),
    Mutation(
        "fillets: stress without that of the volume",
        "solidgear/strength/stress/arc_stress.py",
        "Arc._tensor",
        "2 * sigma[:3] + lame * strain[:3].sum(axis=0)",
        "2 * sigma[:3]",
        "tests/test_fillet_stress.py::test_published_factors_are_met[tension]",
    ),
    Mutation(
        "section forces: a load moves without its moment",
        "solidgear/strength/stress/section_forces.py",
        "move_load",
        "y - target",
        "0.0",
        "tests/test_section_forces.py::test_a_beam_on_two_supports_is_the_textbook_one",
    ),
    Mutation(
        "section forces: spread weight without its arm",
        "solidgear/strength/stress/spread_weight.py",
        "SpreadWeight.between",
        "moment - about * force",
        "np.zeros(6)",
        "tests/test_section_forces.py::test_a_rod_under_its_weight_bends_as_in_the_textbook",
    ),
    Mutation(
        "stress of a train: weight of the gear in the axes of the pinion",
        "solidgear/strength/stress/at_rest.py",
        "_on_shafts",
        "turned @ np.array(state.point.gravity)",
        "np.array(state.point.gravity)",
        "tests/test_stress_command.py::test_both_shafts_of_a_train_balance[axle_straddle-x]",
    ),
    Mutation(
        "stress of a train: a wheel without weight",
        "solidgear/strength/stress/at_rest.py",
        "_on_shafts",
        "head.mass * np.r_[gravity, np.zeros(3)]",
        "np.zeros(6)",
        "tests/test_stress_command.py::test_both_shafts_of_a_train_balance[gearbox_train--z]",
    ),
    Mutation(
        "Peterson: depth of the step over the small diameter",
        "solidgear/strength/stress/published.py",
        "peterson",
        "1 - small / large",
        "large / small - 1",
        "tests/test_stress_report.py::test_a_fillet_is_told_with_its_bars_beside_what_is_published",
    ),
    Mutation(
        "DIN 743: torsion adds as a normal stress does",
        "solidgear/strength/stress/rating.py",
        "_use",
        "math.hypot(normal, shares.get('torsion', 0.0))",
        "normal + shares.get('torsion', 0.0)",
        "tests/test_rating.py::test_stresses_add_as_the_norm_says",
    ),
    Mutation(
        "DIN 743: factors of tests not turned to the diameter of the notch",
        "solidgear/strength/stress/norm/tested.py",
        "at_diameter",
        "size_of_notch(factor, diameter)",
        "size_of_notch(factor, tested)",
        "tests/test_notches_norm.py::test_factors_are_those_by_hand[keyway, 80 mm]",
    ),
    Mutation(
        "Miner: levels below the fatigue limit never count",
        "solidgear/strength/stress/norm/life.py",
        "repetitions",
        "np.cumsum(count * share**exponent)",
        "np.cumsum(np.where(share > 1, count, 0.0) * share**exponent)",
        "tests/test_notches_norm.py::"
        "test_the_consequent_rule_is_that_of_a_limit_that_falls_with_damage[5.0]",
    ),
    Mutation(
        "a notch of a drawing rated at its start alone",
        "solidgear/strength/stress/drawn.py",
        "_Drawn.worst",
        "min(candidates, key=lambda stress: stress.severity)",
        "candidates[0]",
        "tests/test_notches_shaft.py::test_each_notch_is_rated_in_the_section_where_it_is_worst",
    ),
    Mutation(
        "a load acts on notches at the middle of its seat alone",
        "solidgear/strength/stress/section_forces.py",
        "both_sides",
        "range(len(entering) + 1)",
        "range(1)",
        "tests/test_notches_meet.py::test_a_key_that_ends_in_its_hub_takes_all_of_the_torque",
    ),
    Mutation(
        "the moment of a force jumps with the force on its seat",
        "solidgear/strength/stress/section_forces.py",
        "Cut.of",
        "six - load.six",
        "six - move_load(load.six, load.y, self.y)",
        "tests/test_notches_meet.py::"
        "test_section_forces_on_a_seat_are_those_of_both_sides_and_balance",
    ),
    Mutation(
        "notches that overlap count alone",
        "solidgear/strength/stress/norm_notch.py",
        "MeetingNotches.factors",
        "1 + sum(part.notch[load] - 1 for part in each)",
        "each[0].notch[load]",
        "tests/test_notches_meet.py::test_a_hole_in_a_press_fit_is_rated_with_both",
    ),
    Mutation(
        "a ring that slides keeps the rounding of what its one ball held",
        "solidgear/bearings/sliding.py",
        "condense_y",
        "CANCELLED * np.abs(held)",
        "0.0 * np.abs(held)",
        "tests/test_bearings_equilibrium.py::test_one_ball_holds_no_tilt_of_a_ring_that_slides",
    ),
    Mutation(
        "a cross hole takes nothing from its section",
        "solidgear/strength/stress/norm_notch.py",
        "Section.nominal",
        "section.second_moment - cubes / 12",
        "section.second_moment",
        "tests/test_manual.py::test_case[printed_norm_cross_hole-A]",
    ),
    Mutation(
        "profile shifts of REXS follow twice from the centre distance",
        "solidgear/exchange/rexs/profile_shifts.py",
        "_sum_of_shifts",
        "working * count / (2 * tan(normal))",
        "working * count / tan(normal)",
        "tests/test_rexs_open_data.py::test_a_profile_shift_that_is_left_open_follows_from_the_centre_distance",
    ),
    Mutation(
        "turned directions of nodes are turned the other way",
        "solidgear/exchange/matrices/nodes.py",
        "NodeMatrices._in_axes",
        "turn @ table @ turn.T",
        "turn.T @ table @ turn",
        "tests/test_matrices_turned.py::test_options_of_abaqus_have_their_meaning",
    ),
)


def place(mutation: Mutation, text: str) -> tuple[int, int]:
    """First and last offset of what is replaced in the text of a file.

    Raises
    ------
    ValueError
        If there is no such function, or the expression does not occur there exactly once.
    """
    found = [n for n in ast.walk(_function(mutation, text)) if _same(n, mutation.old)]
    # a statement that is an expression holds that expression, in the same place
    spans = {_span(n, text) for n in found}
    if len(spans) != 1:
        raise ValueError(
            f"{mutation.name}: {mutation.old!r} occurs {len(spans)} times in {mutation.where} "
            f"of {mutation.file}"
        )
    return spans.pop()


@cache
def _parsed(text: str) -> ast.Module:
    """Parse a file once for all mutations of it."""
    return ast.parse(text)


def _function(mutation: Mutation, text: str) -> ast.AST:
    node: ast.AST = _parsed(text)
    for name in mutation.where.split("."):
        inside = [n for n in ast.walk(node) if getattr(n, "name", None) == name and n is not node]
        if len(inside) != 1:
            raise ValueError(
                f"{mutation.name}: {mutation.file} has no {mutation.where}, or several"
            )
        node = inside[0]
    return node


@cache
def _wanted(told: str) -> tuple[type[ast.AST], str]:
    """Return the kind of an expression or statement, and what it holds."""
    wanted: ast.AST = ast.parse(told).body[0]
    if isinstance(wanted, ast.Expr):
        wanted = wanted.value
    return type(wanted), ast.dump(wanted)


def _same(node: ast.AST, told: str) -> bool:
    kind, content = _wanted(told)
    return type(node) is kind and ast.dump(node) == content


def _span(node: ast.AST, text: str) -> tuple[int, int]:
    lines = text.encode().splitlines(keepends=True)

    def offset(line: int, column: int) -> int:
        return len((b"".join(lines[: line - 1]) + lines[line - 1][:column]).decode())

    first = offset(node.lineno, node.col_offset)
    return first, offset(node.end_lineno, node.end_col_offset)


def apply(mutation: Mutation, root: Path) -> None:
    """Write the mutated file; `ValueError` as for :func:`place`."""
    path = root / mutation.file
    text = path.read_text()
    first, last = place(mutation, text)
    path.write_text(text[:first] + mutation.new + text[last:])


def passes(test: str, root: Path) -> bool:
    """Whether a test passes on the source under ``root``."""
    env = {**os.environ, "PYTHONPATH": str(root)}
    # wide grids too: one of them may be what sees a mutation
    options = ["-q", "-x", "-n0", "-p", "no:cacheprovider", "-m", "not slow"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, test],
        cwd=root,
        env=env,
        capture_output=True,
        text=True,
    )
    if done.returncode not in (
        0,
        1,
    ):  # 1: tests failed; others: no such test, or a broken collection
        raise RuntimeError(
            f"{test}: pytest ended with {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
        )
    return done.returncode == 0


def copy(root: Path) -> None:
    """Copy what the tests need."""
    for part in PARTS:
        source = ROOT / part
        if source.is_dir():
            shutil.copytree(
                source, root / part, ignore=shutil.ignore_patterns("__pycache__", "results")
            )
        else:
            shutil.copy(source, root / part)


def caught(mutation: Mutation) -> bool:
    """Whether the mutation's test fails on the mutated source."""
    with tempfile.TemporaryDirectory() as folder:
        copy(Path(folder))
        apply(mutation, Path(folder))
        return not passes(mutation.test, Path(folder))


def healthy(test: str) -> bool:
    """Whether a test passes on an unchanged copy: otherwise its failure would prove nothing."""
    with tempfile.TemporaryDirectory() as folder:
        copy(Path(folder))
        return passes(test, Path(folder))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "--only", default="", help="run only mutations with this word in their name"
    )
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    wanted = [m for m in MUTATIONS if arguments.only in m.name]
    tests = sorted({m.test for m in wanted})
    with ThreadPoolExecutor(arguments.jobs) as pool:
        sick = [t for t, ok in zip(tests, pool.map(healthy, tests)) if not ok]
        rows = []
        for mutation, red in zip(wanted, pool.map(caught, wanted)):
            rows.append(
                {
                    "mutation": mutation.name,
                    "file": mutation.file,
                    "test": mutation.test,
                    "caught": "yes" if red else "NO",
                }
            )
            print(f"{'caught' if red else 'MISSED'}  {mutation.name}", flush=True)
    show(f"{len(rows)} mutations, {sum(r['caught'] == 'yes' for r in rows)} caught", rows)
    write_rows(results_folder("mutations") / "rows.csv", rows)
    if sick:
        print("fail without any mutation:", ", ".join(sick))
    if sick or any(r["caught"] != "yes" for r in rows):
        sys.exit(1)


if __name__ == "__main__":
    main()
