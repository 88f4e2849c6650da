//! Contacts as arrays, a row each.

use crate::arrays;
use bowknot::simulator::Contact;
use bowknot::twoway::ContactSide;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The arrays of contacts. Half-spaces are numbered behind so many bodies.
pub fn arrays_of<'py>(py: Python<'py>, contacts: &[Contact], bodies: usize) -> PyResult<Bound<'py, PyDict>> {
    let side = |side: ContactSide| match side {
        ContactSide::Body(body) => body,
        ContactSide::HalfSpace(plane) => bodies as u32 + plane,
    };
    let all = contacts.iter();
    let vectors = |of: fn(&Contact) -> [f64; 3]| arrays::row_array(py, all.clone().map(of));
    let found = PyDict::new(py);
    found.set_item("bodies", arrays::row_array(py, all.clone().map(|c| c.sides.map(side)))?)?;
    found.set_item("vertices", arrays::row_array(py, all.clone().map(|c| c.vertices))?)?;
    found.set_item("weights", arrays::row_array(py, all.clone().map(|c| c.weights))?)?;
    found.set_item("points_a", vectors(|c| c.points[0].coords.into())?)?;
    found.set_item("points_b", vectors(|c| c.points[1].coords.into())?)?;
    found.set_item("normals", vectors(|c| c.normal.into())?)?;
    found.set_item("gaps", arrays::list(py, all.clone().map(|c| c.gap)))?;
    found.set_item("forces", vectors(|c| c.force.into())?)?;
    Ok(found)
}
