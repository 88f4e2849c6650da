//! Which bodies of a collision problem collide: collision groups as arrays of its file.
//!
//! A problem without them is another one wherever bodies of a scene pass through each other on purpose: it
//! would even be refused, because such bodies intersect at the start.

use super::columns::per;
use bowknot_geometry::BodyFilter;
use bowknot_io::IoError;
use bowknot_io::npz::Archive;
use ndarray::Array1;
use ndarray_npy::{NpzWriter, WriteNpzError};
use std::io::{Seek, Write};

/// Bits of the groups that each body is in.
pub(super) const GROUPS: &str = "collision_groups";
/// Bits of the groups that each body meets.
pub(super) const MASK: &str = "collides_with";
/// 1 for bodies that collide with themselves.
pub(super) const SELF_COLLISION: &str = "self_collision";

/// The filter of a body of which a file says nothing.
pub(super) fn default_filter(obstacle: bool) -> BodyFilter {
    if obstacle { BodyFilter::OBSTACLE } else { BodyFilter::DEFORMABLE }
}

/// The filters as a problem keeps them: none if they say no more than which bodies are obstacles.
pub(super) fn kept(filters: Vec<BodyFilter>) -> Vec<BodyFilter> {
    let says_nothing = filters.iter().all(|filter| *filter == default_filter(filter.obstacle));
    if says_nothing { Vec::new() } else { filters }
}

/// Reads the filters of all bodies; none if the archive has no array of them.
///
/// # Errors
/// Another number of entries than of bodies, bits that are no whole number of 32 bits; with the array.
pub(super) fn read(
    archive: &mut Archive<'_>,
    body: &[u32],
    obstacle: &[bool],
) -> Result<Vec<BodyFilter>, IoError> {
    let count = body.iter().max().map_or(0, |&b| b as usize + 1);
    let mut filters = vec![BodyFilter::DEFORMABLE; count];
    for (&body, &obstacle) in body.iter().zip(obstacle) {
        filters[body as usize] = default_filter(obstacle);
    }
    let (groups, mask) = (bits(archive, GROUPS, count)?, bits(archive, MASK, count)?);
    let own = per(archive, SELF_COLLISION, count, ["body", "bodies"])?;
    for (index, filter) in filters.iter_mut().enumerate() {
        filter.groups = groups[index].unwrap_or(filter.groups);
        filter.mask = mask[index].unwrap_or(filter.mask);
        filter.self_collision = own[index].map_or(filter.self_collision, |flag| flag != 0.0);
    }
    Ok(kept(filters))
}

/// A column of bits, one number per body; none for each if the archive has no such array.
fn bits(archive: &mut Archive<'_>, name: &str, count: usize) -> Result<Vec<Option<u32>>, IoError> {
    let mut bits = Vec::with_capacity(count);
    for (body, value) in per(archive, name, count, ["body", "bodies"])?.into_iter().enumerate() {
        let allowed = |v: f64| (0.0..=f64::from(u32::MAX)).contains(&v) && v.fract() == 0.0;
        match value {
            Some(value) if !allowed(value) => {
                let message = format!(
                    "body {body} has {value}; it must be a whole number from 0 to {}, one bit per group",
                    u32::MAX
                );
                return Err(archive.fault(name, message));
            }
            value => bits.push(value.map(|v| v as u32)),
        }
    }
    Ok(bits)
}

/// Writes the filters, if there are any.
///
/// # Errors
/// The refusal of the archive.
pub(super) fn write<W: Write + Seek>(
    archive: &mut NpzWriter<W>,
    filters: &[BodyFilter],
) -> Result<(), WriteNpzError> {
    if filters.is_empty() {
        return Ok(());
    }
    archive.add_array(GROUPS, &filters.iter().map(|f| f.groups).collect::<Array1<u32>>())?;
    archive.add_array(MASK, &filters.iter().map(|f| f.mask).collect::<Array1<u32>>())?;
    archive.add_array(SELF_COLLISION, &filters.iter().map(|f| f.self_collision).collect::<Array1<bool>>())
}
