"""The files that describe an arm: tables of joints, URDF and MJCF."""
