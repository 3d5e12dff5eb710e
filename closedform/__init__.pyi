"""What an author of a derivation imports from closedform.

This file is the one list of these names: type checkers and editors read it, and ``__init__.py``
reads it to find the module of a name that is asked for.
"""

from types import ModuleType

from closedform._version import __version__ as __version__
from closedform.algebra.normal_form import equal as equal
from closedform.algebra.normal_form import normal as normal
from closedform.algebra.normal_form import positive_form as positive_form
from closedform.algebra.solutions import count_solutions as count_solutions
from closedform.algebra.solutions import rotation_parametrisation as rotation_parametrisation
from closedform.lemmas.applied import Applied as Applied
from closedform.lemmas.chain import Chain as Chain
from closedform.lemmas.circles import circle_intersection as circle_intersection
from closedform.lemmas.links import Reaching as Reaching
from closedform.lemmas.links import named as named
from closedform.lemmas.links import polar as polar
from closedform.lemmas.links import remainder as remainder
from closedform.lemmas.links import slide as slide
from closedform.lemmas.links import turn as turn
from closedform.lemmas.links import turned as turned
from closedform.lemmas.links import two_links as two_links
from closedform.lemmas.links import zyz as zyz
from closedform.lemmas.parallelogram import parallelogram as parallelogram
from closedform.lemmas.registry import chain_lemma as chain_lemma
from closedform.lemmas.registry import theorem as theorem
from closedform.lemmas.root import root as root
from closedform.lemmas.rotate import rotate as rotate
from closedform.lemmas.sine_cosine import linear_pair as linear_pair
from closedform.lemmas.sine_cosine import sine_cosine as sine_cosine
from closedform.lemmas.tangent import Links as Links
from closedform.lemmas.tangent import LinksAndWrist as LinksAndWrist
from closedform.lemmas.tangent import LinksAtHeight as LinksAtHeight
from closedform.lemmas.triangle import Triangle as Triangle
from closedform.lemmas.two_link import elbow_squares as elbow_squares
from closedform.lemmas.two_link import two_link_arm as two_link_arm
from closedform.lemmas.two_link import two_link_arm_beside as two_link_arm_beside
from closedform.lemmas.two_sines import two_sines as two_sines
from closedform.lemmas.wrist import spin as spin
from closedform.lemmas.wrist import tilt as tilt
from closedform.lemmas.zyz import zyz_angles as zyz_angles
from closedform.mechanics.arm import from_dh as from_dh
from closedform.mechanics.arm import from_screws as from_screws
from closedform.mechanics.frames import adjoint as adjoint
from closedform.mechanics.frames import angular_velocity_matrix as angular_velocity_matrix
from closedform.mechanics.frames import chain as chain
from closedform.mechanics.frames import denavit_hartenberg as denavit_hartenberg
from closedform.mechanics.frames import determinant as determinant
from closedform.mechanics.frames import exponential as exponential
from closedform.mechanics.frames import hat as hat
from closedform.mechanics.frames import homogeneous as homogeneous
from closedform.mechanics.frames import inverse as inverse
from closedform.mechanics.frames import jacobian as jacobian
from closedform.mechanics.frames import merge_angles as merge_angles
from closedform.mechanics.frames import prismatic_twist as prismatic_twist
from closedform.mechanics.frames import require_pose as require_pose
from closedform.mechanics.frames import require_rotation as require_rotation
from closedform.mechanics.frames import revolute_twist as revolute_twist
from closedform.mechanics.frames import rotation as rotation
from closedform.mechanics.frames import simplest as simplest
from closedform.mechanics.frames import twist_matrix as twist_matrix
from closedform.mechanics.frames import twist_of as twist_of
from closedform.mechanics.loops import degree as degree
from closedform.mechanics.loops import eliminate as eliminate
from closedform.mechanics.loops import velocity_matrices as velocity_matrices
from closedform.mechanics.skeleton import skeleton as skeleton
from closedform.mechanics.volumes import lens as lens
from closedform.model.claims import Check as Check
from closedform.model.claims import Gravity as Gravity
from closedform.model.claims import Reading as Reading
from closedform.model.derivation import Derivation as Derivation
from closedform.model.derivation import Solved as Solved
from closedform.model.derivation import Table as Table
from closedform.model.functions import SINGLE as SINGLE
from closedform.model.functions import Bound as Bound
from closedform.model.functions import Program as Program
from closedform.model.functions import branches as branches
from closedform.model.functions import choose as choose
from closedform.model.functions import real as real
from closedform.model.functions import sign_of as sign_of
from closedform.model.functions import used_up as used_up
from closedform.model.indexed import Indexed as Indexed
from closedform.model.inverse import Combination as Combination
from closedform.model.inverse import Degenerate as Degenerate
from closedform.model.inverse import Inverse as Inverse
from closedform.model.inverse import Link as Link
from closedform.model.lemma import Lemma as Lemma
from closedform.model.notation import SIGN as SIGN
from closedform.model.notation import Notation as Notation
from closedform.model.notation import Relation as Relation
from closedform.model.pair import Pair as Pair
from closedform.model.paper import Paper as Paper
from closedform.model.paper import Work as Work
from closedform.pipeline.run import find as find
from closedform.pipeline.run import load as load
from closedform.proof.checks.completeness import Cases as Cases
from closedform.proof.checks.completeness import Listing as Listing
from closedform.proof.checks.completeness import Replaces as Replaces
from closedform.proof.checks.equations import Agree as Agree
from closedform.proof.checks.equations import Equal as Equal
from closedform.proof.checks.equations import Every as Every
from closedform.proof.checks.equations import Identity as Identity
from closedform.proof.checks.equations import Reaches as Reaches
from closedform.proof.checks.equations import Under as Under
from closedform.proof.checks.solutions import Count as Count
from closedform.proof.checks.solutions import Postures as Postures
from closedform.proof.checks.solutions import Procedure as Procedure
from closedform.proof.checks.solutions import Solves as Solves
from closedform.proof.checks.statements import Enumeration as Enumeration
from closedform.proof.checks.statements import Exists as Exists
from closedform.proof.checks.statements import ForAll as ForAll
from closedform.proof.checks.statements import Holds as Holds
from closedform.proof.checks.statements import Not as Not
from closedform.proof.checks.statements import Rounded as Rounded
from closedform.proof.checks.statements import Undecidable as Undecidable
from closedform.proof.prove import prove as prove
from closedform.scaffold.propose import propose as propose

generated: ModuleType

def __getattr__(name: str) -> ModuleType: ...  # a mechanism, as closedform.puma560
