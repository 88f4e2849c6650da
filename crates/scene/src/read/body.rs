//! Bodies, obstacles and pins.

use super::section::Section;
use super::{material, shape};
use crate::body::BodySpec;
use crate::motion::{Keyframe, Motion};
use crate::obstacle::ObstacleSpec;
use crate::pin::{PinSpec, Region};

pub fn body(section: &Section<'_>, index: usize) -> BodySpec {
    let mut body: BodySpec = section.structure(&["shape", "material"]);
    if body.name.is_empty() {
        body.name = format!("body{index}");
    }
    body.shape = shape::read(section);
    // No material can be read for an unknown kind.
    if section.get("kind").is_none_or(|kind| kind.as_str() == Some(body.kind.name())) {
        body.material = material::read(section, body.kind);
    }
    body
}

pub fn obstacle(section: &Section<'_>, index: usize) -> ObstacleSpec {
    let mut obstacle: ObstacleSpec = section.structure(&["shape", "motion"]);
    if obstacle.name.is_empty() {
        obstacle.name = format!("obstacle{index}");
    }
    obstacle.shape = shape::read(section);
    obstacle.motion = motion(section);
    obstacle
}

pub fn pin(section: &Section<'_>, bodies: &[BodySpec]) -> PinSpec {
    let mut pin: PinSpec = section.structure(&["box", "motion"]);
    if let (true, [only]) = (pin.body.is_empty(), bodies) {
        pin.body.clone_from(&only.name);
    }
    if section.get("box").is_some() {
        pin.region = Some(section.table("box").structure::<Region>(&[]));
    }
    pin.motion = motion(section);
    pin
}

fn motion(section: &Section<'_>) -> Option<Motion> {
    section.get("motion")?;
    let motion = section.table("motion");
    let mut read: Motion = motion.structure(&["keyframes"]);
    let keyframes = motion.tables("keyframes");
    read.keyframes.extend(keyframes.iter().map(|keyframe| keyframe.structure::<Keyframe>(&[])));
    Some(read)
}
