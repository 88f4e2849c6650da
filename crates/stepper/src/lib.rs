//! Moves vertices toward a target along paths that are certified free of intersections.
