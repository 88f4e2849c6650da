//! Buckets and colors of contact rows: what is swept at the same time shares no vertex that moves.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use super::*;
use crate::TwinEngine;
use crate::bricks::LATTICES;
use crate::kernels::color_rows::COLORS;
use crate::layout::{Bucket, Row};
use bowknot_geometry::{BodyFilter, Topology};
use std::collections::{HashMap, HashSet};

const DELTA: f64 = 2e-3;

/// Sheets with different edges above each other, closer than they should be, and particles above a large
/// triangle.
struct Scene {
    model: CollisionModel,
    x: Vec<Point>,
    edges: Vec<f64>,
    prescribed: Vec<bool>,
}

fn scene(random: &mut fastrand::Rng) -> Scene {
    let (mut x, mut edges, mut bodies, mut triangles) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (body, (n, edge)) in [(12u32, 0.01), (16, 0.008), (3, 0.15)].into_iter().enumerate() {
        let first = x.len() as u32;
        let corner = 0.05 * (random.f64() - 0.5);
        for k in 0..n * n {
            let place = [k % n, k / n].map(|k| corner + edge * (f64::from(k) + 0.2 * random.f64()));
            x.push(Point::new(place[0], place[1], 0.5e-3 * body as f64));
            edges.push(edge);
        }
        for k in (0..n * (n - 1)).filter(|k| k % n != n - 1).map(|k| first + k) {
            triangles.extend([[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]);
        }
        bodies.resize(x.len(), body as u32);
    }
    let sheets = x.len();
    // More rows with the same vertex than there are colors.
    for _ in 0..160 {
        x.push(Point::new(0.02 + 0.02 * random.f64(), 0.08 + 0.02 * random.f64(), 2e-3));
        edges.push(2e-3);
    }
    bodies.resize(x.len(), 3);
    let topology = Topology::builder(x.len())
        .triangles(triangles)
        .particles((sheets as u32..x.len() as u32).collect::<Vec<_>>())
        .build()
        .unwrap();
    let mut filters = vec![BodyFilter::DEFORMABLE; 4];
    filters[3].self_collision = false;
    let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
    // Some vertices of the sheets are pinned.
    let prescribed = (0..x.len()).map(|v| v < sheets && random.u8(..8) == 0).collect();
    Scene { model, x, edges, prescribed }
}

/// The rows of a step with their order.
struct Rows {
    rows: Vec<Row>,
    order: Vec<u32>,
    buckets: Vec<Bucket>,
    color_ends: Vec<u32>,
    positions: Vec<[i32; 4]>,
    bricks: Bricks,
}

fn rows(scene: &Scene, bucket_vertices: usize) -> Rows {
    let count = scene.x.len();
    let lengths = Lengths {
        edges: &scene.edges,
        margins: &vec![DELTA; count],
        deltas: &vec![DELTA; count],
        half_space_deltas: &[],
        thicknesses: &[],
        half_space_thicknesses: &[],
        min_separation: 1e-5,
        edge_limits: &[],
    };
    let constraints = Constraints { prescribed: &scene.prescribed, ..Constraints::default() };
    let settings = Settings { bucket_vertices, ..Settings::default() };
    let engine = TwinEngine::new();
    let mut collision =
        Collision::new(engine, &scene.model, &scene.x, &scene.x, &lengths, &constraints, &settings).unwrap();
    let positions: Vec<GridPoint> = snapped(&collision.grid, &scene.x).unwrap();
    collision.begin(&Call::toward(&scene.x)).unwrap();
    collision.step().unwrap();
    let (r, n) = (collision.buffers.rows, collision.row_count);
    let read = [
        (r.rows, words::<Row>(n)),
        (r.order, n),
        (r.buckets, words::<Bucket>(collision.bricks.count())),
        (r.color_ends, n),
    ];
    let mut words = collision.engine.run(&Recording::default(), &read).unwrap();
    Rows {
        rows: bytemuck::cast_slice(&words[0]).to_vec(),
        buckets: bytemuck::cast_slice(&words[2]).to_vec(),
        color_ends: words.pop().unwrap(),
        order: words.swap_remove(1),
        positions: padded(&positions),
        bricks: collision.bricks,
    }
}

impl Rows {
    /// Rows of each color of a bucket, and those without one.
    fn colors(&self, bucket: &Bucket) -> (Vec<&[u32]>, &[u32]) {
        let mut start = bucket.first as usize;
        let colors = (0..bucket.colors as usize).map(|color| {
            let end = self.color_ends[bucket.first as usize + color] as usize;
            let rows = &self.order[start..end];
            start = end;
            rows
        });
        let colors = colors.collect();
        (colors, &self.order[start..bucket.end as usize])
    }

    /// Vertices that a row moves.
    fn parts<'a>(&'a self, scene: &'a Scene, row: u32) -> impl Iterator<Item = u32> {
        let row = &self.rows[row as usize];
        let all = row.vertices.into_iter().zip(row.weights);
        all.filter(|(v, weight)| *weight != 0.0 && !scene.prescribed[*v as usize]).map(|(v, _)| v)
    }

    fn moving<'a>(&'a self, scene: &'a Scene, row: u32) -> HashSet<u32> {
        let vertices = self.rows[row as usize].vertices.into_iter();
        vertices.filter(|v| !scene.prescribed[*v as usize]).collect()
    }
}

#[test]
fn rows_that_are_swept_at_the_same_time_share_no_vertex_that_moves() {
    let mut random = fastrand::Rng::with_seed(1);
    let mut counts = [0; LATTICES + 1];
    let mut uncolored = 0;
    for round in 0..12 {
        let scene = scene(&mut random);
        let all = rows(&scene, if round % 4 == 0 { 1000 } else { 1 << (round % 4) });
        // Each row has one place.
        let mut places = all.order.clone();
        places.sort_unstable();
        assert!(places.into_iter().eq(0..all.rows.len() as u32) && all.rows.len() > 500);
        assert_eq!(all.bricks.buckets == 0, round % 4 == 0);
        let mut end = 0;
        for (k, buckets) in all.bricks.rounds().enumerate() {
            let mut bucket_of = HashMap::new();
            for b in buckets {
                let bucket = &all.buckets[b as usize];
                assert_eq!(bucket.first, end);
                end = bucket.end;
                let (colors, others) = all.colors(bucket);
                for (color, rows) in colors.into_iter().enumerate() {
                    let mut vertices = HashSet::new();
                    for &row in rows {
                        let found = &all.rows[row as usize];
                        assert_eq!((found.color as usize, found.bucket), (color, b));
                        assert!(all.moving(&scene, row).into_iter().all(|v| vertices.insert(v)), "{found:?}");
                    }
                }
                let mut parts: HashMap<u32, u32> = HashMap::new();
                for &row in others {
                    for v in all.parts(&scene, row) {
                        *parts.entry(v).or_default() += 1;
                    }
                }
                assert_eq!(bucket.most, parts.values().copied().max().unwrap_or(0));
                assert!(others.iter().all(|row| all.rows[*row as usize].color == COLORS));
                uncolored += others.len();
                for &row in &all.order[bucket.first as usize..bucket.end as usize] {
                    for v in all.moving(&scene, row) {
                        assert_eq!(*bucket_of.entry(v).or_insert(b), b, "vertex {v} of {row}");
                    }
                    counts[k] += 1;
                }
            }
        }
        assert_eq!(end as usize, all.rows.len());
    }
    assert!(counts.iter().all(|count| *count > 50) && uncolored > 50, "{counts:?} {uncolored}");
}

/// Only rows that extend over more than a quarter of a brick have none.
#[test]
fn rows_of_neighbors_have_a_brick() {
    let mut random = fastrand::Rng::with_seed(2);
    let (mut small, mut large) = (0, 0);
    for _ in 0..4 {
        let scene = scene(&mut random);
        let all = rows(&scene, 4);
        let last = LATTICES as u32 * all.bricks.buckets;
        for (r, row) in all.rows.iter().enumerate() {
            let extent = |axis: usize| {
                let moving = all.moving(&scene, r as u32);
                let coordinates = || moving.iter().map(|v| all.positions[*v as usize][axis]);
                coordinates().max().unwrap_or(0) - coordinates().min().unwrap_or(0)
            };
            if (0..3).all(|axis| extent(axis) <= 1 << (all.bricks.shift - 2)) {
                assert_ne!(row.bucket, last, "{row:?}");
                small += 1;
            } else {
                large += usize::from(row.bucket == last);
            }
        }
    }
    assert!(small > 1000 && large > 100, "{small} {large}");
}
