//! Implicit Euler dynamics of deformable bodies: materials, Newton, block-Jacobi PCG.
