"""Names of the package with the module of each: for type checkers, and read by ``__init__.py``."""

from solidgear.backlash.nonlinear import nonlinear as nonlinear
from solidgear.bearings.elastic_ring import elastic_ring as elastic_ring
from solidgear.comparison.models import compare as compare
from solidgear.core.body import Body as Body
from solidgear.core.body import Supports as Supports
from solidgear.core.errors import SceneError as SceneError
from solidgear.core.errors import SolidgearError as SolidgearError
from solidgear.core.gears.wheel import Rack as Rack
from solidgear.core.gears.wheel import Wheel as Wheel
from solidgear.core.gears.wheel_pair import WheelPair as WheelPair
from solidgear.core.judge.answer import answer as answer
from solidgear.core.judge.asked import modes as modes
from solidgear.core.judge.asked import stiffness as stiffness
from solidgear.core.ladder import build as build
from solidgear.core.loading import load as load
from solidgear.core.reduction.craig_bampton import craig_bampton as craig_bampton
from solidgear.core.reduction.effective_mass import synthesise as synthesise
from solidgear.core.reduction.port_matrices import PortMatrices as PortMatrices
from solidgear.core.reduction.rubin import rubin as rubin
from solidgear.core.reduction.superelement import Superelement as Superelement
from solidgear.core.scene import (
    STEEL as STEEL,
)
from solidgear.core.scene import (
    Ask as Ask,
)
from solidgear.core.scene import (
    Bearing as Bearing,
)
from solidgear.core.scene import (
    Housing as Housing,
)
from solidgear.core.scene import (
    LoadCase as LoadCase,
)
from solidgear.core.scene import (
    Lubrication as Lubrication,
)
from solidgear.core.scene import (
    Material as Material,
)
from solidgear.core.scene import (
    PointMass as PointMass,
)
from solidgear.core.scene import (
    Port as Port,
)
from solidgear.core.scene import (
    Scene as Scene,
)
from solidgear.core.scene import (
    Segment as Segment,
)
from solidgear.core.scene import (
    ShaftLoad as ShaftLoad,
)
from solidgear.core.solve.statics import condense as condense
from solidgear.core.system import (
    BearingSpring as BearingSpring,
)
from solidgear.core.system import (
    Inertia as Inertia,
)
from solidgear.core.system import (
    MeshVector as MeshVector,
)
from solidgear.core.system import (
    Placed as Placed,
)
from solidgear.core.system import (
    PlanetaryTeeth as PlanetaryTeeth,
)
from solidgear.core.system import (
    PortInertia as PortInertia,
)
from solidgear.core.system import (
    RigidBody as RigidBody,
)
from solidgear.core.system import (
    RowSpring as RowSpring,
)
from solidgear.core.system import (
    System as System,
)
from solidgear.core.system import (
    grounded as grounded,
)
from solidgear.core.system import (
    mesh_spring as mesh_spring,
)
from solidgear.core.system import (
    torsion_spring as torsion_spring,
)
from solidgear.core.system.gear_mesh import (
    line_of_action as line_of_action,
)
from solidgear.core.system.gear_mesh import (
    mesh_point as mesh_point,
)
from solidgear.core.system.gear_mesh import (
    to_gear_frame as to_gear_frame,
)
from solidgear.datasheet.study import sheet as sheet
from solidgear.exchange.export import export as export
from solidgear.exchange.matrices.formats import read_matrices as read_matrices
from solidgear.exchange.matrices.source import port_matrices as port_matrices
from solidgear.exchange.rexs.study import import_rexs as import_rexs
from solidgear.guards.check_study import check as check
from solidgear.measured.correlate import correlate as correlate
from solidgear.measured.data import Measured as Measured
from solidgear.measured.data import load_measured as load_measured
from solidgear.measured.identify import identify as identify
from solidgear.measured.overlay import overlay as overlay
from solidgear.measured.shapes import SurfacePoints as SurfacePoints
from solidgear.measured.universal import Responses as Responses
from solidgear.parts.own_mesh import solid_body as solid_body
from solidgear.show.viewer import turn as turn
from solidgear.strength.deflection.study import deflect as deflect
from solidgear.strength.stress.study import stress as stress
from solidgear.teeth.pair_contact import pair_contact as pair_contact
from solidgear.teeth.study import TeethStudy as TeethStudy
from solidgear.teeth.study import contact as contact
from solidgear.teeth.train_teeth import TeethModel as TeethModel
from solidgear.trains.file.train import Train as Train
from solidgear.trains.judge.study import judge as judge
from solidgear.trains.load.bearing import bearing as bearing
from solidgear.trains.loading import load_train as load_train
from solidgear.trains.modes.study import system_modes as system_modes
from solidgear.trains.response.study import receptance as receptance
from solidgear.trains.response.study import response as response
from solidgear.trains.system.carrier_turn import (
    FixedSupport as FixedSupport,
)
from solidgear.trains.system.carrier_turn import (
    PlanetError as PlanetError,
)
from solidgear.trains.system.carrier_turn import (
    carrier_turn as carrier_turn,
)
from solidgear.trains.system.planetary import PlanetaryStage as PlanetaryStage
from solidgear.trains.system.planetary_members import (
    CentralMember as CentralMember,
)
from solidgear.trains.system.planetary_members import (
    Planet as Planet,
)
from solidgear.variants.budget.budget import budget as budget
from solidgear.variants.optimise.optimise import optimise as optimise
from solidgear.variants.sensitivity.run import sensitivities as sensitivities
from solidgear.variants.sweep.file_sweep import sweep as sweep

__version__: str
