"""The projection onto states without intersections by a log barrier made of ipctk's parts.

Minimizes 1/2 sum m |x - y|^2 + kappa b(x) from a state x without intersections: Newton's method on
the projected Hessian, each step cut by continuous collision detection and halved until the energy
falls. (Its minimizers are those of the sum over the square of the time step, kappa scaled alike.)
"""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linear

import toolkit
from measure import Timer


@dataclass
class Outcome:
    x: np.ndarray
    iterations: int = 0
    end: str = "iterations used up"
    cpu: float = 0.0
    wall: float = 0.0
    # CPU seconds of the linear solves.
    solves: float = 0.0
    stiffness: list = field(default_factory=list)


class Barrier:
    """The energy of one problem: the distance to the target, and the barrier of near pairs."""

    def __init__(self, ipctk, problem, barrier_range):
        self.ipctk, self.barrier_range = ipctk, barrier_range
        self.held = (problem["fixed"] | problem["O"]).astype(bool)
        self.x = toolkit.positions(problem["x"])
        self.target = problem["y"].copy()
        self.target[self.held] = problem["x"][self.held]
        self.mesh = toolkit.mesh_of(ipctk, problem["x"], problem["F"], self.held)
        self.masses = np.repeat(problem["mass"], 3)
        self.free = np.repeat(~self.held, 3)
        self.stiffness = 1.0

    def near(self, x):
        """The collisions that the barrier acts on."""
        found = self.ipctk.NormalCollisions()
        found.build(self.mesh, x, self.barrier_range, 0.0, self.ipctk.LBVH())
        return found

    def potential(self):
        return self.ipctk.BarrierPotential(self.barrier_range, self.stiffness)

    def pull(self, x):
        """Gradient of the distance to the target."""
        return self.masses * (x - self.target).ravel()

    def energy(self, x, near):
        away = (x - self.target).ravel()
        return 0.5 * float(self.masses @ away**2) + self.potential()(near, self.mesh, x)

    def gradient(self, x, near):
        return self.pull(x) + self.potential().gradient(near, self.mesh, x)

    def hessian(self, x, near):
        clamp = self.ipctk.PSDProjectionMethod.CLAMP
        curvature = self.potential().hessian(near, self.mesh, x, clamp)
        return (sparse.diags(self.masses) + curvature).tocsc()

    def balance(self, x, near):
        """Sets the stiffness by ipctk's rule; returns the largest one that it allows."""
        size = float(np.linalg.norm(np.ptp(x, axis=0)))
        mean_mass = float(self.masses[self.free].mean())
        # The stiffness is still 1 here.
        forces = self.potential().gradient(near, self.mesh, x)
        barrier = self.ipctk.ClampedLogBarrier()
        self.stiffness, most = self.ipctk.initial_barrier_stiffness(
            size, barrier, self.barrier_range, mean_mass, self.pull(x), forces
        )
        return most


def project(ipctk, problem, barrier_range, tolerance, max_iterations, max_seconds):
    """Iterates until no vertex would move by more than `tolerance` [m]."""
    energy = Barrier(ipctk, problem, barrier_range)
    timer = Timer()
    x = energy.x
    out = Outcome(x)
    near = energy.near(x)
    most = energy.balance(x, near)
    size = float(np.linalg.norm(np.ptp(x, axis=0)))
    gap = _gap(energy, near, x)
    for _ in range(max_iterations):
        gradient = energy.gradient(x, near)
        step = _newton_step(energy, x, near, gradient, out)
        if np.abs(step).max() <= tolerance:
            out.end = "converged"
            break
        x, near, moved = _descend(energy, x, near, step, float(gradient @ step.ravel()))
        if not moved:
            out.end = "line search failed"
            break
        out.iterations += 1
        last, gap = gap, _gap(energy, near, x)
        energy.stiffness = ipctk.update_barrier_stiffness(last, gap, most, energy.stiffness, size)
        out.stiffness.append(energy.stiffness)
        if timer.wall() > max_seconds:
            out.end = "out of time"
            break
    out.x, out.cpu, out.wall = x, timer.cpu(), timer.wall()
    return out


def _gap(energy, near, x):
    """The smallest distance, or the barrier's range if no pair is within it."""
    return near.compute_minimum_distance(energy.mesh, x) ** 0.5 if len(near) else energy.barrier_range


def _newton_step(energy, x, near, gradient, out):
    free = energy.free
    hessian = energy.hessian(x, near)[free][:, free].tocsc()
    timer = Timer()
    # The fastest ordering and options of SuperLU for symmetric matrices.
    options = {"SymmetricMode": True}
    factors = linear.splu(hessian, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    step = np.zeros(len(gradient))
    step[free] = -factors.solve(gradient[free])
    out.solves += timer.cpu()
    return step.reshape(-1, 3)


def _descend(energy, x, near, step, slope):
    """The longest step, halved again and again, that has no collisions and lowers the energy enough."""
    candidates = energy.ipctk.Candidates()
    end = toolkit.positions(x + step)
    candidates.build(energy.mesh, x, end, 0.0, energy.ipctk.LBVH())
    length = candidates.compute_collision_free_stepsize(energy.mesh, x, end)
    before = energy.energy(x, near)
    for _ in range(40):
        moved = toolkit.positions(x + length * step)
        near_moved = energy.near(moved)
        if energy.energy(moved, near_moved) <= before + 1e-4 * length * slope:
            return moved, near_moved, True
        length *= 0.5
    return x, near, False
