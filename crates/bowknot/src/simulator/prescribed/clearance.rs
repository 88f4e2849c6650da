//! What is in the place of an obstacle that is to appear.
//!
//! **This test is part of the guarantee.** The collision stage keeps what is apart apart; it needs a start
//! without intersections. So an obstacle appears only if no element of it intersects one of a deformable
//! body, by the exact predicates of the judge, and none is nearer than the minimum separation of the two.

use crate::simulator::start::Enclosure;
use bowknot_check::{CheckError, Judge, StateOptions};
use bowknot_geometry::{Aabb, BodyFilter, CollisionModel, PairKind, Point};
use bowknot_proximity::{PairList, ProximitySearch};
use bowknot_scene::BodyKind;
use bowknot_scene::world::{World, WorldBody};
use bowknot_twoway::CollisionScene;

/// What is in the way of an obstacle of the world, or of a half-space, numbered after the bodies, in words;
/// none if its place is clear. `positions` are those of all vertices that collide [m].
///
/// # Errors
/// Coordinates beyond what exact arithmetic can take.
pub(super) fn in_the_way(
    world: &World,
    scene: &CollisionScene,
    positions: &[Point],
    obstacle: usize,
) -> Result<Option<String>, CheckError> {
    if world.bodies.get(obstacle).is_some_and(|_| is_far(world, scene, positions, obstacle)) {
        return Ok(None);
    }
    let model = alone(world, obstacle);
    let options = StateOptions { limit: 1, distance: false };
    let report = Judge::from_model(&model).check_state(positions, &options)?;
    let other = |vertices: [u32; 2]| {
        let of_body = |v: &u32| model.vertex_body()[*v as usize] as usize != obstacle;
        vertices.iter().find(|v| of_body(v)).map_or("", |&v| world.body_name(v as usize))
    };
    if let Some(first) = report.intersections.first() {
        let sides = [0, 1].map(|side| first.vertices[side].first().unwrap_or(&first.vertices[0][0]));
        let (name, place) = (other(sides.map(|v| *v)), words(&first.place));
        return Ok(Some(format!("it would cut {name} at {place}")));
    }
    let too_near = nearest(scene, &model, positions).map(|([a, b], distance)| {
        let (name, place) = (other([a, b]), words(&positions[a as usize]));
        format!("it would be {distance:.3e} m from {name} at {place}, nearer than the minimum separation")
    });
    Ok(too_near.or_else(|| encloses(world, positions, obstacle)))
}

fn words(place: &Point) -> String {
    format!("({:.6}, {:.6}, {:.6}) m", place.x, place.y, place.z)
}

/// Whether the box of an obstacle is beyond the reach of all boxes of deformable bodies.
fn is_far(world: &World, scene: &CollisionScene, positions: &[Point], obstacle: usize) -> bool {
    let bounds = |body: usize| {
        let vertices = &world.bodies[body].vertices;
        let own = &positions[vertices.start as usize..vertices.end as usize];
        Aabb::of_points(own).inflated(scene.spacing().margin(body as u32))
    };
    let own = bounds(obstacle);
    (0..world.bodies.len()).filter(|&b| world.bodies[b].kind.is_some()).all(|b| !own.overlaps(&bounds(b)))
}

/// The collision model in which all that collides is the obstacle with deformable bodies: these are its
/// obstacles, which form no pairs.
fn alone(world: &World, obstacle: usize) -> CollisionModel {
    let filter = |(body, filter): (usize, &BodyFilter)| match world.bodies[body].kind {
        _ if body == obstacle => BodyFilter { obstacle: false, self_collision: false, ..*filter },
        // Those of a half-space must not be obstacles.
        Some(_) if obstacle < world.bodies.len() => BodyFilter { obstacle: true, ..*filter },
        _ => filter.absent(),
    };
    let filters: Vec<BodyFilter> = world.collision.bodies().iter().enumerate().map(filter).collect();
    let planes = world.collision.half_spaces().iter().zip(world.bodies.len()..);
    let planes: Vec<_> =
        planes.map(|(plane, h)| if h == obstacle { *plane } else { plane.absent() }).collect();
    let mut model = world.collision.clone();
    model.set_filters(&filters, &planes);
    model
}

/// The vertices of a pair that is nearer than its minimum separation, one of each side, and its distance [m].
fn nearest(scene: &CollisionScene, model: &CollisionModel, positions: &[Point]) -> Option<([u32; 2], f64)> {
    let radii: Vec<f64> = model.vertex_body().iter().map(|&body| scene.spacing().margin(body)).collect();
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    ProximitySearch::new(model).search(model, positions, &radii, &mut pairs, &mut separations);
    let of_kind = |kind: PairKind| pairs.range(kind).map(move |place| (kind, place));
    let too_near = |&(kind, place): &(PairKind, usize)| {
        // A distance that is not a number is too near.
        let least = scene.min_separation(kind, &pairs.pairs()[place]);
        separations[place].distance.partial_cmp(&least).is_none_or(std::cmp::Ordering::is_lt)
    };
    let (kind, place) = PairKind::ALL.into_iter().flat_map(of_kind).find(too_near)?;
    let vertices = pairs.pairs()[place].vertices;
    let other = if kind == PairKind::VertexHalfSpace { 0 } else { kind.side_a() };
    Some(([vertices[0], vertices[other]], separations[place].distance))
}

/// What is inside of what, if the obstacle would be inside of a solid or have a body inside.
fn encloses(world: &World, positions: &[Point], obstacle: usize) -> Option<String> {
    world.bodies.get(obstacle)?;
    let is_met = |(b, body): &(usize, &WorldBody)| {
        body.kind.is_some() && world.collision.may_collide(*b as u32, obstacle as u32)
    };
    let own = Enclosure::new(world, positions, obstacle);
    world.bodies.iter().enumerate().filter(is_met).find_map(|(b, body)| {
        if own.as_ref().is_some_and(|own| own.holds(b)) {
            return Some(format!("{} would be inside of it", body.name));
        }
        let solid = (body.kind == Some(BodyKind::Solid)).then(|| Enclosure::new(world, positions, b))?;
        solid?.holds(obstacle).then(|| format!("it would be inside of {}", body.name))
    })
}
