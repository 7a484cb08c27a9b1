"""A search through the networks that pruning leaves, of all agents at once."""

from verify.programs.joint.layers import JointLayers, JointPath, JointPathsError

__all__ = ["JointLayers", "JointPath", "JointPathsError"]
