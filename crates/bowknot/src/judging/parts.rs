//! Parts of a mesh by name, and which of them are exempt.

use super::clips::{Clip, Frames};
use super::error::JudgingError;
use super::params::JudgingParams;
use crate::geometry::BodyFilter;
use crate::io::Mesh;

/// Marks the obstacles among the parts and drops the elements of those that are left out. Returns a filter
/// for each part; none if nothing is exempt.
pub(super) fn exempt(mesh: &mut Mesh, params: &JudgingParams) -> Vec<BodyFilter> {
    let Some(body) = &mesh.body else { return Vec::new() };
    let marked = |patterns: &[String]| -> Option<Vec<bool>> {
        let parts: Vec<bool> =
            mesh.names.iter().map(|name| patterns.iter().any(|pattern| matches(pattern, name))).collect();
        parts.contains(&true).then(|| body.iter().map(|&part| parts[part as usize]).collect())
    };
    let (obstacles, left_out) = (marked(&params.obstacles), marked(&params.left_out));
    if let Some(obstacles) = obstacles {
        let flags = mesh.obstacle.get_or_insert_with(|| vec![false; obstacles.len()]);
        flags.iter_mut().zip(obstacles).for_each(|(flag, obstacle)| *flag |= obstacle);
    }
    if let Some(left_out) = left_out {
        mesh.leave_out(&left_out);
    }
    if params.may_intersect_themselves.is_empty() {
        return Vec::new();
    }
    let may = |name: &String| params.may_intersect_themselves.iter().any(|pattern| matches(pattern, name));
    let filter = |name| BodyFilter { self_collision: !may(name), ..BodyFilter::DEFORMABLE };
    mesh.names.iter().map(filter).collect()
}

/// Refuses names that no part has in the first frame of any file.
pub(super) fn check_patterns(clips: &[Clip], params: &JudgingParams) -> Result<(), JudgingError> {
    let all = [&params.obstacles, &params.may_intersect_themselves, &params.left_out];
    let mut missing: Vec<&String> = all.into_iter().flatten().collect();
    if missing.is_empty() {
        return Ok(());
    }
    let mut parts: Vec<String> = Vec::new();
    for clip in clips {
        // All files of a folder have the parts of the first, as a rule.
        let Some(file) = clip.files().first() else { continue };
        let Frames::Meshes(source) = clip.open(file, params)? else { continue };
        let mut mesh = source.read(0)?;
        mesh.name_parts(&clip.name());
        parts.extend(mesh.names.into_iter().filter(|name| !parts.contains(name)).collect::<Vec<_>>());
        missing.retain(|pattern| !parts.iter().any(|name| matches(pattern, name)));
        if missing.is_empty() {
            return Ok(());
        }
    }
    match missing.first() {
        Some(&pattern) => Err(JudgingError::NoSuchPart { pattern: pattern.clone(), parts }),
        None => Ok(()),
    }
}

/// Whether a name is that of a pattern, in which each `*` stands for any characters.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(name) = name.strip_prefix(start) else { return false };
    (0..=name.len()).filter(|&end| name.is_char_boundary(end)).any(|end| matches(rest, &name[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_any_characters() {
        for (pattern, name) in [("a", "a"), ("*", ""), ("/World/*", "/World/arm"), ("*arm*", "left_arm_2")] {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("a", "ab"), ("arm", "left_arm"), ("a*c", "ab"), ("é*", "e")] {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }
}
