//! A device that has computed another scene of equal size begins anew.

use bowknot_geometry::{Point, Topology, Vector};
use bowknot_gpu::{Device, TwinEngine};
use bowknot_twoway::proximity::CollisionModel;
use bowknot_twoway::{Params, ResolveInput, Resolver};

/// Particles, of which those above want to go below the others. With `strands`, neighbors are joined to strands that
/// cross: then nothing passes.
fn heap(strands: bool) -> (Resolver, Vec<Point>, Vec<Point>) {
    const SIDE: u32 = 4;
    let count = 2 * SIDE * SIDE;
    let place = |v: u32| [v % SIDE, v / SIDE % SIDE, v / (SIDE * SIDE)].map(f64::from);
    let x: Vec<Point> = (0..count)
        .map(place)
        .map(|[x, y, z]| Point::new(0.1 * x + 0.05 * z, 0.1 * y + 0.003 * z, 0.05 * z))
        .collect();
    let y = x.iter().map(|p| p - 3.0 * p.z * Vector::z()).collect();
    let lower = (0..count / 2).filter(|v| v % SIDE < SIDE - 1).map(|v| [v, v + 1]);
    let upper = (count / 2..count - SIDE).map(|v| [v, v + SIDE]);
    let joined = lower.chain(upper).filter(|_| strands);
    let topology = Topology::builder(x.len()).strand_edges(joined).particles(0..count);
    let model = CollisionModel::single_body(topology.build().expect("elements of their own vertices"));
    let mut params = Params::fast();
    params.contact.delta = Some(0.01);
    let resolver = Resolver::new(model, &x, &vec![1.0; x.len()], params).expect("a scene");
    (resolver, x, y)
}

#[test]
fn a_device_sees_another_scene_of_equal_size() {
    let mut device = Device::new("twins".to_owned(), TwinEngine::new());
    let (mut particles, start, y) = heap(false);
    device.prepare(particles.scene(), &start).expect("supported");
    let resolve = |resolver: &mut Resolver, device: &mut Device<TwinEngine>| {
        let mut x = start.clone();
        device.resolve(resolver, &mut x, &y, &ResolveInput::default(), &mut ()).expect("a call");
        device.judge(resolver.scene(), &x).expect("nothing intersects");
        x
    };
    let apart = resolve(&mut particles, &mut device);
    let (mut strands, ..) = heap(true);
    let found = resolve(&mut strands, &mut device);

    let mut fresh = Device::new("twins".to_owned(), TwinEngine::new());
    let (mut strands, start, _) = heap(true);
    fresh.prepare(strands.scene(), &start).expect("supported");
    assert!(found == resolve(&mut strands, &mut fresh));
    assert!(found != apart);
}
