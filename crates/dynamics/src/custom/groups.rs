//! What is checked of groups of custom elements.

use super::element::{CustomElement, ElementGroup, MAX_ELEMENT_VERTICES};
use crate::error::{ElementProblem, ModelError};
use std::collections::HashSet;
use std::sync::Arc;

/// Checks groups for a model; `obstacle` has the name of the obstacle that each vertex belongs to, None for
/// those of deformable bodies.
pub(crate) fn check_groups<'a>(
    groups: &[ElementGroup],
    vertex_count: usize,
    obstacle: impl Fn(u32) -> Option<&'a str>,
) -> Vec<ModelError> {
    let mut errors = Vec::new();
    let mut names = HashSet::new();
    for ElementGroup { name, elements } in groups {
        if !names.insert(name) {
            errors.push(ModelError::RepeatedGroup { group: name.clone() });
        }
        for (index, element) in elements.iter().enumerate() {
            for problem in problems(element.vertices(), vertex_count, &obstacle) {
                errors.push(ModelError::CustomElement { group: name.clone(), index, problem });
            }
        }
    }
    errors
}

fn problems<'a>(
    vertices: &[u32],
    vertex_count: usize,
    obstacle: &impl Fn(u32) -> Option<&'a str>,
) -> Vec<ElementProblem> {
    let given = vertices.len();
    if !(1..=MAX_ELEMENT_VERTICES).contains(&given) {
        return vec![ElementProblem::Count { given, most: MAX_ELEMENT_VERTICES }];
    }
    let mut problems = Vec::new();
    for (k, &vertex) in vertices.iter().enumerate() {
        if vertex as usize >= vertex_count {
            problems.push(ElementProblem::OutOfRange { vertex, count: vertex_count });
        } else if vertices[..k].contains(&vertex) {
            problems.push(ElementProblem::Repeated { vertex });
        } else if let Some(obstacle) = obstacle(vertex) {
            problems.push(ElementProblem::Obstacle { vertex, obstacle: obstacle.to_owned() });
        }
    }
    problems
}

/// The index of a group whose place `elements` may take: they must have the same vertices.
pub(crate) fn check_replacement(
    groups: &[ElementGroup],
    name: &str,
    elements: &[Arc<dyn CustomElement>],
) -> Result<usize, ModelError> {
    let Some(index) = groups.iter().position(|group| group.name == name) else {
        let known = groups.iter().map(|group| group.name.clone()).collect();
        return Err(ModelError::UnknownGroup { group: name.to_owned(), known });
    };
    let before = &groups[index].elements;
    if before.len() != elements.len() {
        let (given, expected) = (elements.len(), before.len());
        return Err(ModelError::ElementCount { group: name.to_owned(), given, expected });
    }
    let differs = |(before, now): &(&Arc<dyn CustomElement>, &Arc<dyn CustomElement>)| {
        before.vertices() != now.vertices()
    };
    match before.iter().zip(elements).enumerate().find(|(_, pair)| differs(pair)) {
        Some((index, (before, _))) => {
            let problem = ElementProblem::OtherVertices { expected: before.vertices().to_vec() };
            Err(ModelError::CustomElement { group: name.to_owned(), index, problem })
        }
        None => Ok(index),
    }
}
