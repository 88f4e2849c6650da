//! A tent on a ground, drawn without a window; without a driver, what to install.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_render::geometry::{HalfSpace, Point, Vector};
use bowknot_render::{Elements, Fit, Frame, Model, Quality, RenderError, Renderer, Shot, Style, View};

fn main() -> Result<(), RenderError> {
    let points = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let points = points.map(Point::from);
    let elements =
        Elements { triangles: &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], ..Elements::default() };
    let model = Model::new(&elements, &points, &Style { strand_radius: 0.01, particle_radius: 0.01 })?;
    let mut fit = Fit::new(View::ThreeQuarter, 30.0, 1.0);
    points.iter().for_each(|p| fit.add(p, 0.0));
    let ground = vec![HalfSpace { normal: Vector::z(), offset: 0.0 }];
    let shot = Shot { ground, ..Shot::new(fit.camera(), [64, 64]) };

    let mut renderer = match Renderer::new(Quality::FAST) {
        Err(error @ RenderError::NoDriver { .. }) => {
            println!("{error}");
            return Ok(());
        }
        other => other?,
    };
    let picture = renderer.render(&model, &Frame { positions: &points, values: &[] }, &shot)?;
    println!("the middle is {:?}, a corner {:?}", picture.at(32, 32), picture.at(0, 0));
    assert_ne!(picture.at(32, 32), picture.at(0, 0));
    Ok(())
}

#[test]
fn runs() {
    main().expect("a picture, or word of a missing driver");
}
