//! Contact and edge-length constraints: values, Jacobians, colours.
