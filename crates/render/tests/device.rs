//! Pictures that a device has drawn: what must be seen is there.
//!
//! Without a driver these tests say so and pass; CI installs a software driver.

// The helpers belong to the tests: a panic is a failure, and what is skipped is said.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use bowknot_render::geometry::{HalfSpace, Point, Vector};
use bowknot_render::{Camera, Elements, Frame, Model, Picture, Quality, RenderError, Renderer, Shot, Style};

/// Quick, and fine enough for what is looked at.
const QUALITY: Quality =
    Quality { key_lights: 8, sky_lights: 24, penumbra_taps: 4, shadow_map: 512, supersampling: 1 };
const SIZE: [u32; 2] = [160, 120];
const STYLE: Style = Style { strand_radius: 0.16, particle_radius: 0.25 };

/// None, with a word about it, on a machine without a driver.
fn renderer() -> Option<Renderer> {
    match Renderer::new(QUALITY) {
        Ok(renderer) => Some(renderer),
        Err(error @ RenderError::NoDriver { .. }) => {
            assert!(std::env::var_os("BOWKNOT_NEED_DRIVER").is_none(), "{error}");
            println!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// From above the front at the origin.
fn camera() -> Camera {
    Camera { eye: Point::new(0.0, -6.0, 3.0), target: Point::origin(), fov: 30.0 }
}

fn shot() -> Shot {
    Shot { ground: vec![HalfSpace { normal: Vector::z(), offset: -0.5 }], ..Shot::new(camera(), SIZE) }
}

fn square(z: f64) -> (Vec<Point>, [[u32; 3]; 2]) {
    let corners = [[-0.5, -0.5, z], [0.5, -0.5, z], [0.5, 0.5, z], [-0.5, 0.5, z]];
    (corners.map(Point::from).to_vec(), [[0, 1, 2], [0, 2, 3]])
}

/// Where a point is seen.
fn pixel(camera: &Camera, p: Point) -> [u32; 2] {
    let [right, up, back] = camera.axes().unwrap();
    let d = p - camera.eye;
    let f = f64::from(SIZE[1]) / 2.0 / (camera.fov.to_radians() / 2.0).tan() / -d.dot(&back);
    [f64::from(SIZE[0]) / 2.0 + f * d.dot(&right), f64::from(SIZE[1]) / 2.0 - f * d.dot(&up)]
        .map(|v| v as u32)
}

fn light(pixel: [u8; 3]) -> f64 {
    pixel.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0
}

/// Largest difference of the channels: 0 for gray.
fn tint(pixel: [u8; 3]) -> u8 {
    pixel.iter().max().unwrap() - pixel.iter().min().unwrap()
}

fn draw(renderer: &mut Renderer, elements: &Elements<'_>, points: &[Point], shot: &Shot) -> Picture {
    let model = Model::new(elements, points, &STYLE).unwrap();
    renderer.render(&model, &Frame { positions: points, values: &[] }, shot).unwrap()
}

#[test]
fn a_sheet_stands_where_it_is_and_throws_a_soft_shadow() {
    let Some(mut renderer) = renderer() else { return };
    let (points, triangles) = square(0.3);
    let with =
        draw(&mut renderer, &Elements { triangles: &triangles, ..Elements::default() }, &points, &shot());
    let empty = draw(&mut renderer, &Elements::default(), &points, &shot());
    assert_eq!((with.width, with.height), (SIZE[0], SIZE[1]));

    // Colored on the sheet, and beyond its corners not.
    let at = |p: Point| pixel(&camera(), p);
    for (p, inside) in [
        (Point::new(0.0, 0.0, 0.3), true),
        (Point::new(0.45, 0.45, 0.3), true),
        (Point::new(-0.45, -0.45, 0.3), true),
        (Point::new(0.6, 0.0, 0.3), false),
        (Point::new(0.0, 0.65, 0.3), false),
    ] {
        let [x, y] = at(p);
        assert_eq!(tint(with.at(x, y)) > 40, inside, "{p}: {:?}", with.at(x, y));
    }

    // Below it the ground is darker, from the middle of the shadow outward less and less, far away not at
    // all.
    let ground = |x: f64, y: f64| {
        let [x, y] = at(Point::new(x, y, -0.5));
        light(with.at(x, y)) - light(empty.at(x, y))
    };
    // The key light comes from the left in front: the shadow lies to the right behind.
    let (middle, far) = (ground(0.5, 0.2), ground(-1.3, 0.0));
    assert!(middle < -25.0, "the shadow is {middle}");
    assert!(far.abs() < 6.0, "light is missing far away: {far}");
    let across: Vec<f64> = (0..40).map(|k| ground(0.5 + 0.02 * f64::from(k), 0.2)).collect();
    let steepest = across.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    assert!(steepest < 0.5 * -middle, "a step of {steepest} is no soft shadow: {across:?}");
    // Shadow darkens but tints little.
    let [x, y] = at(Point::new(0.5, 0.2, -0.5));
    assert!(tint(with.at(x, y)) < 25);
}

/// The shadow of a sheet two sides above the ground: along a row through its penumbra the light grows without
/// steps.
#[test]
fn the_penumbra_of_a_far_caster_has_no_bands() {
    let Some(_) = renderer() else { return };
    let (points, triangles) = square(1.5);
    let elements = Elements { triangles: &triangles, ..Elements::default() };
    // The middle of the shadow lies there, see the key light.
    let target = Point::new(1.5, 1.0, -0.5);
    let camera = Camera { eye: target + (camera().eye - Point::origin()), target, fov: 30.0 };
    let shot = Shot { camera, ..Shot { size: [320, 240], ..shot() } };
    let fine = Quality { shadow_map: 512, ..Quality::FINE };
    for (quality, steepest, sharpest) in [(Quality::FAST, 0.11, 0.08), (fine, 0.09, 0.03)] {
        let mut renderer = Renderer::new(quality).unwrap();
        let picture = draw(&mut renderer, &elements, &points, &shot);
        // Means over squares of two pixels, as the eye sees them; from the middle of the shadow to the right.
        let mean = |k: u32| {
            let square = [[0, 0], [1, 0], [0, 1], [1, 1]];
            square.iter().map(|[i, j]| light(picture.at(160 + 2 * k + i, 120 + j))).sum::<f64>() / 4.0
        };
        let across: Vec<f64> = (0..50).map(mean).collect();
        let depth = across[49] - across[0];
        assert!(depth > 40.0, "there is no shadow: {across:?}");
        for pair in across.windows(2) {
            let step = (pair[1] - pair[0]) / depth;
            // The penumbra is some 20 squares wide: 0.05 each, and twice that in its middle.
            assert!(step > -0.03 && step < steepest, "a step of {step} at {}: {across:?}", pair[0]);
        }
        // Bands are flat with steps between them: there the light grows by turns.
        let bend = across.windows(3).map(|w| (w[2] - 2.0 * w[1] + w[0]).abs() / depth).fold(0.0, f64::max);
        assert!(bend < sharpest, "a bend of {bend}: {across:?}");
    }
}

#[test]
fn both_sides_are_shaded_and_differ() {
    let Some(mut renderer) = renderer() else { return };
    let (points, triangles) = square(0.0);
    let turned = triangles.map(|[a, b, c]| [a, c, b]);
    let bare = Shot::new(camera(), SIZE);
    let mut seen = |triangles: &[[u32; 3]], obstacle: &[bool]| {
        let elements = Elements { triangles, obstacle, ..Elements::default() };
        draw(&mut renderer, &elements, &points, &bare).at(SIZE[0] / 2, SIZE[1] / 2)
    };
    let (front, back) = (seen(&triangles, &[]), seen(&turned, &[]));
    assert!(light(front) > 60.0 && light(back) > 60.0, "neither side is black: {front:?} {back:?}");
    let distance: i32 = (0..3).map(|c| (i32::from(front[c]) - i32::from(back[c])).abs()).sum();
    assert!(distance > 25, "the sides look alike: {front:?} {back:?}");
    // An obstacle is gray, and the same on both sides.
    let sides = [seen(&triangles, &[true; 4]), seen(&turned, &[true; 4])];
    assert_eq!(sides[0], sides[1]);
    assert!(tint(sides[0]) < 16, "{sides:?}");
}

#[test]
fn balls_are_round_and_strands_are_tubes() {
    let Some(mut renderer) = renderer() else { return };
    let points = [Point::new(0.8, 0.0, 0.0), Point::new(-1.2, 0.0, 0.0), Point::new(-0.4, 0.0, 0.0)];
    let elements = Elements { particles: &[0], strands: &[[1, 2]], ..Elements::default() };
    let picture = draw(&mut renderer, &elements, &points, &Shot::new(camera(), SIZE));
    let [right, up, _] = camera().axes().unwrap();
    // Inside and outside the outline all around.
    for k in 0..16 {
        let (s, c) = (f64::from(k) * std::f64::consts::FRAC_PI_8).sin_cos();
        for (share, inside) in [(0.8, true), (1.25, false)] {
            let [x, y] = pixel(&camera(), points[0] + (right * c + up * s) * (STYLE.particle_radius * share));
            assert_eq!(tint(picture.at(x, y)) > 30, inside, "{k}, {share}: {:?}", picture.at(x, y));
        }
    }
    // Lit from the left above: that side of the ball is lighter than the other.
    let side = |sign: f64| {
        let offset = (up - right) * (sign * 0.5 * STYLE.particle_radius);
        let [x, y] = pixel(&camera(), points[0] + offset);
        light(picture.at(x, y))
    };
    assert!(side(1.0) > side(-1.0) + 30.0, "{} {}", side(1.0), side(-1.0));
    // The tube, as thick as asked for, with a round end beyond its last point.
    let middle = points[1] + (points[2] - points[1]) * 0.5;
    for (offset, inside) in [(up * 0.1, true), (up * 0.24, false), (-up * 0.1, true), (-up * 0.24, false)] {
        let [x, y] = pixel(&camera(), middle + offset);
        assert_eq!(tint(picture.at(x, y)) > 20, inside, "{offset}");
    }
    let [x, y] = pixel(&camera(), points[2] + Vector::x() * 0.09);
    assert!(tint(picture.at(x, y)) > 20);
}

/// A ball and a sheet that cut each other show the cut: balls have depth, not only an outline.
#[test]
fn balls_stand_in_space() {
    let Some(mut renderer) = renderer() else { return };
    let (mut points, triangles) = square(0.0);
    points.push(Point::origin());
    let obstacle = [true, true, true, true, false];
    let elements =
        Elements { triangles: &triangles, particles: &[4], obstacle: &obstacle, ..Elements::default() };
    let picture = draw(&mut renderer, &elements, &points, &Shot::new(camera(), SIZE));
    let at = |p| {
        let [x, y] = pixel(&camera(), p);
        picture.at(x, y)
    };
    // The upper half is seen, the lower one is below the sheet.
    assert!(tint(at(Point::new(0.0, 0.0, 0.2))) > 30);
    assert!(tint(at(Point::new(0.0, -0.3, 0.0))) < 20);
}

#[test]
fn the_same_frame_gives_the_same_pixels() {
    let Some(mut renderer) = renderer() else { return };
    let (points, triangles) = square(0.2);
    let elements = Elements { triangles: &triangles, ..Elements::default() };
    let first = draw(&mut renderer, &elements, &points, &shot());
    // Another picture in between, of another size, leaves nothing behind.
    draw(&mut renderer, &Elements::default(), &points, &Shot::new(camera(), [64, 64]));
    assert_eq!(draw(&mut renderer, &elements, &points, &shot()), first);
}

/// Values go through the color map, evenly between vertices.
#[test]
fn values_are_shown_by_the_map() {
    let Some(mut renderer) = renderer() else { return };
    let (points, triangles) = square(0.0);
    let model =
        Model::new(&Elements { triangles: &triangles, ..Elements::default() }, &points, &STYLE).unwrap();
    let bare = Shot::new(camera(), SIZE);
    let mut seen = |value: f32| {
        let frame = Frame { positions: &points, values: &[value; 4] };
        renderer.render(&model, &frame, &bare).unwrap().at(SIZE[0] / 2, SIZE[1] / 2)
    };
    let [low, middle, high] = [0.0, 0.5, 1.0].map(&mut seen);
    // Violet, teal, yellow.
    assert!(low[2] > low[1] && low[0] > low[1], "{low:?}");
    assert!(middle[1] > middle[0] && middle[2] > middle[0], "{middle:?}");
    assert!(high[0] > high[2] + 60 && high[1] > high[2] + 60, "{high:?}");
    assert!(light(low) < light(middle) && light(middle) < light(high));
}

#[test]
fn impossible_sizes_and_cameras_are_refused() {
    let Some(mut renderer) = renderer() else { return };
    let (points, _) = square(0.0);
    let model = Model::new(&Elements::default(), &points, &STYLE).unwrap();
    let frame = Frame { positions: &points, values: &[] };
    for size in [[0, 100], [100, 3], [4_000_000, 100]] {
        let refused = renderer.render(&model, &frame, &Shot::new(camera(), size));
        assert!(matches!(refused, Err(RenderError::Size { .. })), "{size:?}");
    }
    let blind = Camera { target: camera().eye, ..camera() };
    let refused = renderer.render(&model, &frame, &Shot::new(blind, SIZE));
    assert!(matches!(refused, Err(RenderError::CameraAtTarget(_))));
}
