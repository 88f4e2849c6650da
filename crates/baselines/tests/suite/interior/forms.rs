//! Contact constraints in place of the volume form.

use crate::common::{Scene, resolve_watched};
use bowknot_baselines::twoway::constraints::ContactForm;
use bowknot_baselines::twoway::{Params, Resolver};

#[test]
fn sheets_that_want_to_change_places_never_intersect_with_rows_along_faces() {
    let scene = Scene::turned_sheets(4, 0.04);
    let target = scene.swapped();
    let mut params = Params::paper();
    params.contact.form = ContactForm::Face;
    params.solver.stop.max_steps = Some(100);
    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![0.01; scene.x.len()], params).unwrap();
    let (x, report) = resolve_watched(&mut resolver, &scene, &target, "faces");
    assert!(report.contact_rows > 10, "they never met: {report:?}");
    let middle = x.len() / 4;
    assert!(x[middle].z < x[middle + x.len() / 2].z, "they passed through each other");
}
