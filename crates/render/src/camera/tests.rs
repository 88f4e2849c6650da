use super::*;

/// Coordinates of a point in the picture, where 1 is the edge.
fn project(camera: &Camera, aspect: f64, point: &Point) -> [f64; 2] {
    let [right, up, back] = camera.axes().unwrap();
    let d = point - camera.eye;
    let t = (camera.fov.to_radians() / 2.0).tan();
    let depth = -d.dot(&back);
    assert!(depth > 0.0, "{point} is behind the camera");
    [d.dot(&right) / depth / t / aspect, d.dot(&up) / depth / t]
}

const VIEWS: [View; 4] = [View::Front, View::Side, View::Top, View::ThreeQuarter];

#[test]
fn everything_is_seen_and_fills_the_picture() {
    let corners: Vec<Point> = (0..8)
        .map(|k| Point::new(f64::from(k & 1), f64::from(k >> 1 & 1) * 3.0, f64::from(k >> 2) * 0.5))
        .collect();
    for view in VIEWS {
        for aspect in [0.5, 1.0, 1.8] {
            let mut fit = Fit::new(view, 30.0, aspect);
            corners.iter().for_each(|p| fit.add(p, 0.0));
            let camera = fit.camera();
            let mut extreme = [0.0_f64; 2];
            for p in &corners {
                let [x, y] = project(&camera, aspect, p);
                extreme = [extreme[0].max(x.abs()), extreme[1].max(y.abs())];
            }
            let largest = extreme[0].max(extreme[1]);
            let expected = 1.0 - 2.0 * MARGIN;
            assert!((largest - expected).abs() < 1e-9, "{view:?} {aspect}: {extreme:?}");
        }
    }
}

#[test]
fn a_ball_is_seen_whole() {
    let center = Point::new(1.0, -2.0, 3.0);
    let mut fit = Fit::new(View::ThreeQuarter, 40.0, 1.5);
    fit.add(&center, 0.5);
    let camera = fit.camera();
    let [right, up, _] = camera.axes().unwrap();
    for k in 0..360 {
        let (s, c) = f64::from(k).to_radians().sin_cos();
        let [x, y] = project(&camera, 1.5, &(center + (right * c + up * s) * 0.5));
        assert!(x.abs() < 1.0 && y.abs() < 1.0 - MARGIN);
    }
}

#[test]
fn degenerate_fits_still_look_somewhere() {
    let empty = Fit::new(View::Top, 30.0, 1.0).camera();
    assert!(empty.axes().is_ok());
    let mut fit = Fit::new(View::Front, 30.0, 1.0);
    fit.add(&Point::new(5.0, 5.0, 5.0), 0.0);
    let single = fit.camera();
    assert!(single.axes().is_ok());
    assert!(project(&single, 1.0, &Point::new(5.0, 5.0, 5.0))[0].abs() < 1e-6);
    let at_target = Camera { eye: Point::origin(), target: Point::origin(), fov: 30.0 };
    assert!(at_target.axes().is_err());
}
