//! Queries of a mesh and distances of triangles beside parry3d-f64: CPU time per query, and by how
//! much results differ. Markdown.
//!
//! ```text
//! cargo run --release -p bowknot-proximity --example time_queries -- [RINGS [ROUNDS]]
//! ```
//! The mesh is a bumpy closed ball of RINGS rings. Both programs take turns; times are medians over the rounds.
#![allow(clippy::print_stdout)]

use bowknot_geometry::{Point, Vector, separation};
use bowknot_proximity::MeshQuery;
use fastrand::Rng;
use parry3d_f64::math::{Pose, Vector as Theirs};
use parry3d_f64::query::{self, PointQuery, Ray, RayCast};
use parry3d_f64::shape::{TriMesh, TriMeshFlags, Triangle};
use std::error::Error;
use std::f64::consts::{PI, TAU};

const QUERIES: usize = 20_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<u32>());
    let rings = arguments.next().unwrap_or(Ok(160))?.max(3);
    let rounds = arguments.next().unwrap_or(Ok(5))?.max(1) as usize;
    let mut random = Rng::with_seed(1);
    let (x, triangles) = ball(rings, 2 * rings, &mut random);
    println!("{} vertices, {} triangles; nanoseconds per query\n", x.len(), triangles.len());
    println!("| query | bowknot | parry3d-f64 | ratio | difference |");
    println!("|---|---|---|---|---|");

    let corners: Vec<Theirs> = x.iter().map(theirs).collect();
    let their_mesh = || TriMesh::new(corners.clone(), triangles.clone());
    let made = medians(rounds, || MeshQuery::new(&x, &triangles).is_ok(), || their_mesh().is_ok());
    row("build, per triangle", triangles.len(), made, String::new());
    let mut mesh = MeshQuery::new(&x, &triangles)?;
    let refitted = medians(rounds, || mesh.refit(&x).is_ok(), || ());
    row("new positions, per triangle", triangles.len(), [refitted[0], f64::NAN], String::new());
    let their_mesh = their_mesh()?;

    // parry's pseudo-normals decide about insides; they need flags, with which other queries are the same.
    let oriented = TriMesh::with_flags(corners.clone(), triangles.clone(), TriMeshFlags::ORIENTED)?;
    for (name, low, high) in [("near the surface", 0.85, 1.05), ("anywhere", 0.0, 3.0)] {
        let points: Vec<Point> = (0..QUERIES)
            .map(|_| Point::from(direction(&mut random) * (low + (high - low) * random.f64())))
            .collect();
        let ours = |p: &Point| mesh.closest_point(p, f64::INFINITY).map_or(f64::NAN, |found| found.distance);
        let parrys = |p: &Point| their_mesh.distance_to_local_point(theirs(p), false);
        let times = medians(rounds, || sum(&points, ours), || sum(&points, parrys));
        row(&format!("closest point, {name}"), QUERIES, times, differences(&points, ours, parrys));

        let inside = |p: &Point| f64::from(u8::from(mesh.is_inside(p) == Some(true)));
        let parrys = |p: &Point| f64::from(u8::from(oriented.contains_local_point(theirs(p))));
        let times = medians(rounds, || sum(&points, inside), || sum(&points, parrys));
        let others = points.iter().filter(|p| inside(p) != parrys(p)).count();
        row(&format!("inside, {name}"), QUERIES, times, format!("{others} others"));
    }

    let rays: Vec<(Point, Vector)> =
        (0..QUERIES).map(|_| (Point::from(direction(&mut random) * 2.0), direction(&mut random))).collect();
    let aimed: Vec<(Point, Vector)> = rays.iter().map(|(p, d)| (*p, (Point::from(*d) - p) * 0.5)).collect();
    let at_vertices: Vec<(Point, Vector)> =
        (0..QUERIES).map(|_| (Point::origin(), x[random.usize(..x.len())].coords)).collect();
    for (name, rays) in [("aimed", aimed), ("into space", rays), ("at vertices from inside", at_vertices)] {
        let ours = |(p, d): &(Point, Vector)| mesh.cast_ray(p, d, f64::INFINITY).map_or(9.0, |hit| hit.t);
        let parrys = |(p, d): &(Point, Vector)| {
            let ray = Ray::new(theirs(p), Theirs::new(d.x, d.y, d.z));
            their_mesh.cast_local_ray(&ray, f64::MAX, false).map_or(9.0, |t| t)
        };
        let times = medians(rounds, || sum(&rays, ours), || sum(&rays, parrys));
        let missed =
            |hit: &dyn Fn(&(Point, Vector)) -> f64| rays.iter().filter(|ray| hit(ray) == 9.0).count();
        let both: Vec<_> = rays.iter().filter(|ray| ours(ray) < 9.0 && parrys(ray) < 9.0).copied().collect();
        let missed = format!("misses {} and {}", missed(&ours), missed(&parrys));
        row(
            &format!("ray, {name}"),
            QUERIES,
            times,
            format!("{}, {missed}", differences(&both, ours, parrys)),
        );
    }

    for (name, apart) in [("apart", 4.0), ("near, some intersect", 0.5)] {
        let pairs: Vec<[Point; 6]> = (0..QUERIES)
            .map(|_| {
                let aside = direction(&mut random) * apart;
                [0, 0, 0, 1, 1, 1].map(|side| Point::from(direction(&mut random) + aside * f64::from(side)))
            })
            .collect();
        let ours =
            |[a, b, c, d, e, f]: &[Point; 6]| separation::triangle_triangle([a, b, c], [d, e, f]).distance;
        let parrys = |points: &[Point; 6]| {
            let [a, b, c, d, e, f] = points.map(|p| theirs(&p));
            let (first, second) = (Triangle::new(a, b, c), Triangle::new(d, e, f));
            query::distance(&Pose::IDENTITY, &first, &Pose::IDENTITY, &second)
                .map_or(f64::NAN, |d| d.distance)
        };
        let times = medians(rounds, || sum(&pairs, ours), || sum(&pairs, parrys));
        row(&format!("two triangles, {name}"), QUERIES, times, differences(&pairs, ours, parrys));
    }
    Ok(())
}

/// A ball with a bumpy surface, seen from outside counterclockwise.
fn ball(rings: u32, sectors: u32, random: &mut Rng) -> (Vec<Point>, Vec<[u32; 3]>) {
    let mut x = vec![Point::new(0.0, 0.0, 1.0), Point::new(0.0, 0.0, -1.0)];
    let mut triangles = Vec::new();
    let index = |ring: u32, sector: u32| match ring {
        0 => 0,
        _ if ring == rings => 1,
        _ => 2 + (ring - 1) * sectors + sector % sectors,
    };
    for ring in 1..rings {
        for sector in 0..sectors {
            let up = PI * f64::from(ring) / f64::from(rings);
            let around = TAU * f64::from(sector) / f64::from(sectors);
            let place = Point::new(up.sin() * around.cos(), up.sin() * around.sin(), up.cos());
            x.push(place * (0.95 + 0.05 * random.f64()));
            let (here, next) = (index(ring, sector), index(ring, sector + 1));
            // With the rings above and below; at the poles the same point twice would make no triangle.
            triangles.push([here, next, index(ring - 1, sector + 1)]);
            triangles.push([here, index(ring + 1, sector), next]);
        }
    }
    (x, triangles)
}

/// A direction of length 1.
fn direction(random: &mut Rng) -> Vector {
    loop {
        let v = Vector::from([0; 3].map(|_| 2.0 * random.f64() - 1.0));
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

fn theirs(p: &Point) -> Theirs {
    Theirs::new(p.x, p.y, p.z)
}

fn sum<T>(queries: &[T], query: impl Fn(&T) -> f64) -> f64 {
    queries.iter().map(query).sum()
}

/// The largest difference of two answers.
fn differences<T>(queries: &[T], ours: impl Fn(&T) -> f64, theirs: impl Fn(&T) -> f64) -> String {
    let largest = queries.iter().map(|q| (ours(q) - theirs(q)).abs()).fold(0.0, f64::max);
    format!("{largest:.1e}")
}

/// Median seconds of two programs that take turns.
fn medians<A, B>(rounds: usize, mut ours: impl FnMut() -> A, mut theirs: impl FnMut() -> B) -> [f64; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..rounds {
        let start = cpu_seconds();
        std::hint::black_box(ours());
        let middle = cpu_seconds();
        std::hint::black_box(theirs());
        times[0].push(middle - start);
        times[1].push(cpu_seconds() - middle);
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[rounds / 2]
    })
}

/// CPU seconds that this process has used; 0 where the system does not tell.
fn cpu_seconds() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    0.0
}

fn row(name: &str, queries: usize, [ours, theirs]: [f64; 2], difference: String) {
    let per = 1e9 / queries as f64;
    let cell =
        |value: f64, digits: usize| if value.is_nan() { String::new() } else { format!("{value:.digits$}") };
    let (ours, theirs, ratio) = (cell(ours * per, 0), cell(theirs * per, 0), cell(theirs / ours, 1));
    println!("| {name} | {ours} | {theirs} | {ratio} | {difference} |");
}
