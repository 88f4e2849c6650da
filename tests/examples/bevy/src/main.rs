//! A cloth falls on a box that turns, sways and goes where the arrow keys say. The README has the commands.
//!
//! `simulation.rs` joins Bowknot to Bevy; this file is the game.

mod simulation;
#[cfg(test)]
mod tests;

use bevy::asset::AssetPlugin;
use bevy::input::InputPlugin;
use bevy::prelude::*;
use bowknot::{Scene, SimulationError, Simulator};
use simulation::{BeforeStep, BowknotPlugin, Leads, Report, Surface};
use std::process::ExitCode;
use std::time::Duration;

const USAGE: &str = "usage: bowknot-bevy-example [--headless STEPS]";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments.iter().map(String::as_str).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &[&str]) -> Result<(), String> {
    // What is wrong with a scene is known before a window opens.
    let simulator = simulator().map_err(|error| error.to_string())?;
    let steps =
        |text: &str| text.parse().map_err(|_| format!("{text:?} is no number of time steps\n{USAGE}"));
    match *arguments {
        [] => {
            App::new().add_plugins((DefaultPlugins, BowknotPlugin::new(simulator), game, view)).run();
            Ok(())
        }
        ["--headless", count] => advance(&mut headless(simulator), steps(count)?),
        _ => Err(USAGE.to_owned()),
    }
}

fn simulator() -> Result<Simulator, SimulationError> {
    Simulator::new(&Scene::from_toml(include_str!("../scene.toml"), ".")?)
}

/// The rules of the game: an entity whose Transform the box follows.
fn game(app: &mut App) {
    app.add_systems(Startup, |mut commands: Commands| {
        commands.spawn((Leads("box"), Transform::default()));
    });
    app.add_systems(FixedUpdate, steer.in_set(BeforeStep));
}

/// Moves the box at up to half a meter per second, in the time of the simulation.
fn steer(
    keys: Res<ButtonInput<KeyCode>>,
    time: Res<Time>,
    report: Res<Report>,
    mut way: Local<Vec3>,
    mut leader: Single<&mut Transform, With<Leads>>,
) {
    let axis = |less, more| f32::from(keys.pressed(more)) - f32::from(keys.pressed(less));
    let direction =
        vec3(axis(KeyCode::ArrowLeft, KeyCode::ArrowRight), 0.0, axis(KeyCode::ArrowUp, KeyCode::ArrowDown));
    *way += 0.5 * time.delta_secs() * direction.normalize_or_zero();
    let seconds = report.last.time as f32;
    leader.translation = *way + vec3(0.1 * ops::sin(2.0 * seconds), 0.0, 0.0);
    leader.rotation = Quat::from_rotation_y(0.6 * seconds);
}

/// Camera, light, ground, colors and text: nothing that the simulation needs.
fn view(app: &mut App) {
    app.add_systems(Startup, set_up_view).add_systems(Update, tell);
}

fn set_up_view(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    surfaces: Query<(Entity, &Name), With<Surface>>,
) {
    let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
    let place = |x, y, z| Transform::from_xyz(x, y, z).looking_at(vec3(0.0, -0.15, 0.0), Vec3::Y);
    commands.spawn((Camera3d::default(), place(0.6, 0.55, 1.2)));
    commands.spawn((sun, place(-1.0, 3.0, 1.5)));
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(6.0, 6.0))),
        MeshMaterial3d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
        Transform::from_xyz(0.0, -0.3, 0.0),
    ));
    for (entity, name) in &surfaces {
        let color =
            if name.as_str() == "cloth" { Color::srgb(0.8, 0.2, 0.2) } else { Color::srgb(0.9, 0.7, 0.3) };
        // A cloth is seen from both sides.
        let cloth = StandardMaterial { double_sided: true, cull_mode: None, ..StandardMaterial::from(color) };
        commands.entity(entity).insert(MeshMaterial3d(materials.add(cloth)));
    }
    commands.spawn(Text::default());
}

fn tell(report: Res<Report>, mut text: Single<&mut Text>) {
    text.0 = format!("{}\nArrow keys move the box", summary(&report));
}

fn summary(report: &Report) -> String {
    let Report { last, intersections, error } = report;
    let (steps, milliseconds) = (last.step, 1e3 * last.seconds.total);
    let mut lines = format!("{intersections} intersections after {steps} time steps ({milliseconds:.0} ms)");
    for (name, distance) in &last.waiting {
        lines += &format!("\n{name} waits for what is in its way, {:.1} mm behind", 1e3 * distance);
    }
    if let Some(error) = error {
        lines += &format!("\nThe simulation has stopped: {error}");
    }
    lines
}

/// The same simulation and game without a window.
fn headless(simulator: Simulator) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, AssetPlugin::default(), InputPlugin)).init_asset::<Mesh>();
    app.add_plugins((BowknotPlugin::new(simulator), game));
    app.finish();
    app.cleanup();
    app
}

/// Runs frames until the simulator has made a number of time steps, and says what happened.
fn advance(app: &mut App, steps: usize) -> Result<(), String> {
    while app.world().resource::<Report>().last.step < steps {
        app.update();
        let report = app.world().resource::<Report>();
        if report.error.is_some() {
            return Err(summary(report));
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    println!("{}", summary(app.world().resource::<Report>()));
    Ok(())
}
