//! Linear complementarity problems over sparse rows, and their projected solvers.
