//! A sheet over a ball, a ring and a hook of strand, and some grains on a ground: `still_life.png`.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_render::geometry::{HalfSpace, Point, Vector};
use bowknot_render::{
    Elements, Fit, Frame, Legend, Model, Quality, Renderer, Scale, Shot, Style, View, write_png,
};
use std::f64::consts::TAU;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    // A sheet that follows a bell, with a wave.
    let n = 60_u32;
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (f64::from(i) / f64::from(n) - 0.5, f64::from(j) / f64::from(n) - 0.5);
            let bell = 0.35 * (-9.0 * (x * x + y * y)).exp();
            points.push(Point::new(x, y, 0.02 + bell + 0.012 * (25.0 * x).sin() * (x * x + y * y)));
        }
    }
    let quad =
        |triangles: &mut Vec<[u32; 3]>, [a, b, c, d]: [u32; 4]| triangles.extend([[a, b, c], [a, c, d]]);
    for i in 0..n {
        for j in 0..n {
            let at = |i: u32, j: u32| i * (n + 1) + j;
            quad(&mut triangles, [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    let sheet = points.len();
    // A ring and a hook.
    let mut strands = Vec::new();
    let first = points.len() as u32;
    let ring = 80_u32;
    for k in 0..ring {
        let (s, c) = (TAU * f64::from(k) / f64::from(ring)).sin_cos();
        points.push(Point::new(0.75 + 0.15 * c, -0.1 + 0.15 * s, 0.03 + 0.02 * (3.0 * s).sin()));
        strands.push([first + k, first + (k + 1) % ring]);
    }
    for k in 0..40_u32 {
        let t = f64::from(k) / 39.0;
        let (s, c) = (4.5 * t).sin_cos();
        points.push(Point::new(0.75 + 0.1 * (1.0 - c), 0.3 + 0.05 * t, 0.02 + 0.12 * s.abs()));
        if k > 0 {
            strands.push([first + ring + k - 1, first + ring + k]);
        }
    }
    let strand_end = points.len();
    // Grains in a heap.
    let mut particles = Vec::new();
    for layer in 0..4 {
        let side = 7 - 2 * layer;
        for k in 0..side * side {
            let (i, j) = (f64::from(k % side - side / 2), f64::from(k / side - side / 2));
            particles.push(points.len() as u32);
            let height = 0.02 + 0.029 * f64::from(layer);
            points.push(Point::new(0.1 + 0.04 * i, -0.78 + 0.04 * j, height));
        }
    }
    let body: Vec<u32> =
        (0..points.len()).map(|v| u32::from(v >= sheet) + u32::from(v >= strand_end)).collect();
    // Colors by height on the grains and strands.
    let values: Vec<f32> = points
        .iter()
        .enumerate()
        .map(|(v, p)| if v < sheet { f32::NAN } else { (p.z / 0.15) as f32 })
        .collect();

    let elements = Elements {
        triangles: &triangles,
        strands: &strands,
        particles: &particles,
        obstacle: &[],
        body: &body,
    };
    let model = Model::new(&elements, &points, &Style { strand_radius: 0.012, particle_radius: 0.02 })?;
    let legend = Legend::Scale(Scale {
        title: "height".to_owned(),
        unit: "m".to_owned(),
        low: 0.0,
        high: 0.15,
        beyond: [false; 2],
    });
    let size = [800, 600];
    let legend_width = legend.width(size[1]);
    let mut fit = Fit::new(View::ThreeQuarter, 26.0, f64::from(size[0] - legend_width) / f64::from(size[1]));
    points.iter().for_each(|p| fit.add(p, 0.02));
    let ground = vec![HalfSpace { normal: Vector::z(), offset: 0.0 }];
    let shot = Shot { legend_width, ground, ..Shot::new(fit.camera(), size) };

    let mut renderer = Renderer::new(Quality::FINE)?;
    let mut picture = renderer.render(&model, &Frame { positions: &points, values: &values }, &shot)?;
    legend.draw(&mut picture);
    let out = std::env::args().nth(1).unwrap_or_else(|| "still_life.png".to_owned());
    write_png(std::fs::File::create(&out)?, &picture)?;
    println!("{out}: drawn on {}", renderer.device_name());
    Ok(())
}
