"""The names and shapes of the contract, robot by robot."""

from typing import Any

SINGLE_LOOP = {
    "jacobian_parallel": (2, 1, 1),
    "jacobian_serial": (2, 1),
    "jacobian": (2, 1, 1),
    "determinant": (2,),
    "singularities": (2, 2),
}


def six(*fields: str, third: str = "theta3", **more: tuple[int, ...]) -> dict[str, Any]:
    """An arm of six joints with eight postures."""
    return {
        "fields": fields,
        "joints": ("theta1", "theta2", third, "theta4", "theta5", "theta6"),
        "task": tuple(f"T{i}{j}" for i in range(1, 5) for j in range(1, 5)),
        "shapes": {
            "fk": (4, 4),
            "pose": (4, 4),
            "jacobian": (6, 6),
            "jacobian_space": (6, 6),
            "jacobian_body": (6, 6),
            "determinant": (),
            "singularities": (3,),
            **more,
        },
        "branches": 8,
    }


def seven(*fields: str, **more: tuple[int, ...]) -> dict[str, Any]:
    """An arm of seven joints, whose inverse takes one more input than the pose."""
    arm = six(*fields, **more)
    jacobians = {name: (6, 7) for name in arm["shapes"] if name.startswith("jacobian")}
    arm["shapes"] |= {"singularities": (4,), **jacobians}
    return {**arm, "joints": tuple(f"theta{i}" for i in range(1, 8))}


def legs(n: int) -> dict[str, tuple[int, ...]]:
    """The shapes of a hand on ``n`` legs."""
    return {
        "jacobian_parallel": (2, n, n),
        "jacobian_serial": (2, n),
        "jacobian": (2, n, n),
        "determinant": (2,),
        "condition_number": (2,),
        "singularities": (2, n + 1),
    }


ROBOTS = {
    "planar_2r": {
        "fields": ("l1", "l2"),
        "joints": ("theta1", "theta2"),
        "task": ("x", "y"),
        "shapes": {
            "fk": (2,),
            "pose": (4, 4),
            "orientation": (),
            "jacobian": (3, 2),
            "determinant": (),
            "singularities": (1,),
        },
        "branches": 2,
    },
    "spherical_wrist": {
        "fields": ("d6",),
        "joints": ("theta4", "theta5", "theta6"),
        "task": tuple(f"R{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)),
        "shapes": {
            "fk": (3, 3),
            "pose": (4, 4),
            "jacobian_space": (3, 3),
            "jacobian_body": (3, 3),
            "determinant": (),
            "singularities": (1,),
        },
        "branches": 2,
    },
    "irb260": {
        "fields": ("l1", "l2", "l3", "l4", "l5", "l6"),
        "joints": ("theta1", "theta2", "theta3", "theta5"),
        "task": ("x", "y", "z", "yaw"),
        "shapes": {
            "fk": (4,),
            "pose": (4, 4),
            "joint4": (),
            "motors_from_joints": (4,),
            "joints_from_motors": (4,),
            "jacobian": (4, 4),
            "jacobian_space": (6, 4),
            "jacobian_body": (6, 4),
            "jacobian_motors": (4, 4),
            "determinant": (),
            "singularities": (2,),
        },
        "branches": 4,
    },
    "puma560": six("a2", "a3", "d3", "d4"),
    "irb2400": six(
        "a1", "d1", "a2", "a3", "d4", "d6", motors_from_joints=(6,), joints_from_motors=(6,)
    ),
    "opw_arm": six("a1", "a2", "b", "c1", "c2", "c3", "c4"),
    "srs_arm": seven("d_bs", "d_se", "d_ew", "d_wf", self_motion=(7,), arm_angle=()),
    "franka_arm": seven("d1", "d3", "a4", "a5", "d5", "a7", "d7"),
    "stanford_arm": six("d2", third="d3"),
    "hybrid_five_bar": {
        "fields": ("L0", "L1", "L2"),
        "joints": ("theta1", "theta2", "theta3"),
        "task": ("x", "y", "z"),
        "shapes": {
            "passive_angles": (2, 2),
            "jacobian_parallel": (2, 3, 3),
            "jacobian_serial": (2, 3),
            "jacobian": (2, 3, 3),
            "determinant": (2,),
            "condition_number": (2,),
            "singularities": (2, 4),
        },
        "branches": 8,
        "assembly_modes": 2,
    },
    "scara": {
        "fields": ("l1", "l2", "h"),
        "joints": ("theta1", "theta2", "d3", "theta4"),
        "task": ("x", "y", "z", "yaw"),
        "shapes": {
            "fk": (4,),
            "pose": (4, 4),
            "jacobian": (4, 4),
            "jacobian_space": (6, 4),
            "jacobian_body": (6, 4),
            "determinant": (),
            "singularities": (1,),
        },
        "branches": 2,
    },
    "ur_arm": six("d1", "L2", "L3", "d4", "d5", "d6"),
    "rpr_planar": {
        "fields": ("b",),
        "joints": ("rho1", "rho2"),
        "task": ("x", "y"),
        "shapes": {"passive_angles": (2, 2), **legs(2)},
        "branches": 1,
        "assembly_modes": 2,
    },
    "five_bar": {
        "fields": ("L0", "L1", "L2", "L3", "L4"),
        "joints": ("theta1", "theta2"),
        "task": ("x", "y"),
        "shapes": {"passive_angles": (2, 2), **legs(2)},
        "branches": 4,
        "assembly_modes": 2,
    },
    "delta": {
        "fields": ("f", "e", "L", "l", "alpha1", "alpha2", "alpha3"),
        "joints": ("theta1", "theta2", "theta3"),
        "task": ("x", "y", "z"),
        "shapes": {"constraint": (2, 1), **legs(3)},
        "branches": 8,
        "assembly_modes": 2,
    },
    "linear_delta": {
        "fields": ("f", "e", "l"),
        "joints": ("rho1", "rho2", "rho3"),
        "task": ("x", "y", "z"),
        "shapes": {"constraint": (2, 1), **legs(3)},
        "branches": 8,
        "assembly_modes": 2,
    },
    "orthoglide": {
        "fields": ("L",),
        "joints": ("rho1", "rho2", "rho3"),
        "task": ("x", "y", "z"),
        "shapes": {"constraint": (2, 1), **legs(3)},
        "branches": 8,
        "assembly_modes": 2,
    },
    "spherical_five_bar": {
        "fields": ("r", "gamma", "alpha1", "alpha2", "beta1", "beta2"),
        "joints": ("theta1", "theta2"),
        "task": ("x", "y", "z"),
        "shapes": {
            "jacobian_parallel": (2, 3, 3),
            "jacobian_serial": (2, 2),
            "jacobian": (2, 3, 2),
            "condition_number": (2,),
            "singularities": (2, 3),
        },
        "branches": 4,
        "assembly_modes": 2,
    },
    "agile_wrist": {
        "fields": ("r",),
        "joints": ("theta1", "theta2", "theta3"),
        "task": tuple(f"R{i}{j}" for i in range(1, 4) for j in range(1, 4)),
        "hand": (3, 3),
        "shapes": {
            "passive_angles": (4, 3),
            "jacobian_parallel": (4, 3, 3),
            "jacobian_serial": (4, 3),
            "jacobian_space": (4, 3, 3),
            "determinant": (4,),
            "condition_number": (4,),
            "singularities": (4, 4),
        },
        "branches": 8,
        "assembly_modes": 4,
    },
    "four_bar": {
        "fields": ("L1", "L2", "L3", "L4"),
        "joints": ("theta",),
        "task": ("psi",),
        "shapes": SINGLE_LOOP,
        "branches": 2,
        "assembly_modes": 2,
    },
    "slider_crank": {
        "fields": ("r", "l", "e"),
        "joints": ("theta",),
        "task": ("x",),
        "shapes": SINGLE_LOOP,
        "branches": 2,
        "assembly_modes": 2,
    },
}
H6AR = {
    "fields": ("L1", "L2", "a3", "d1", "d", "gs", "al", "loff", "lp"),
    "joints": ("theta1", "theta2R", "theta3R", "theta2L", "theta3L", "theta"),
    "task": ("x", "y", "z", "psi", "phi", "theta"),
    "shapes": {
        "fk": (6,),
        "pose": (4, 4),
        "arm_tips": (2, 3),
        "invariant_point": (3,),
        "jacobian": (6, 6),
        "determinant": (),
        "singularities": (6,),
    },
    "twins": True,
}
ROBOTS |= {"h6ar": {**H6AR, "branches": 4}, "h6ar_loop_closed": {**H6AR, "branches": 8}}
WITHOUT_FORWARD_MAP = {
    "three_prs": {
        "fields": ("b", "a", "l"),
        "joints": ("rho1", "rho2", "rho3"),
        "task": ("z", "tilt_x", "tilt_y"),
        "posture": {
            "jacobian_parallel": (3, 3),
            "jacobian_serial": (3,),
            "jacobian_inverse": (3, 3),
            "jacobian": (3, 3),
            "determinant": (),
            "singularities": (5,),
        },
        "target": {"hand_pose": (4, 4), "workspace_contains": ()},
        "branches": 8,
    },
}
"""What takes a target and joints that belong together, and what takes a target."""
