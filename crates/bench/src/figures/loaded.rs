//! Scenes in which bodies press on each other.

/// A sheet between two boxes that leave it less than two contact distances.
pub const SLOT: &str = r#"
[simulation]
gravity = [0, 0, 0]
[[body]]
shape = { type = "sheet", size = [0.04, 0.04], edge = 0.01 }
[[obstacle]]
shape = { type = "box", size = [0.05, 0.05, 0.02], edge = 0.025 }
translate = [0, 0, -0.0115]
[[obstacle]]
shape = { type = "box", size = [0.05, 0.05, 0.02], edge = 0.025 }
translate = [0, 0, 0.0114]
"#;

/// A cube of rubber on a sheet on the ground.
pub const CUBE_ON_SHEET: &str = r#"
[contact]
delta = 0.001
[[body]]
name = "sheet"
shape = { type = "sheet", size = [0.3, 0.3], edge = 0.02 }
translate = [0, 0, 0.001]
friction = 0.3
[[body]]
name = "cube"
kind = "solid"
shape = { type = "block", size = [0.06, 0.06, 0.06], edge = 0.02 }
translate = [0, 0, 0.0325]
friction = 0.3
material = "rubber"
[[obstacle]]
shape = { type = "half-space" }
friction = 0.3
"#;

/// A strip of denim between two pads of rubber, under its own weight.
pub const STRIP: &str = r#"
[simulation]
air_drag = 1
[contact]
delta = 0.002
[[body]]
name = "strip"
shape = { type = "sheet", size = [0.1, 0.3], edge = 0.02 }
rotate = [90, 0, 0]
translate = [0, 0, -0.12]
friction = 0.5
material = "denim"
[[body]]
name = "left"
kind = "solid"
shape = { type = "block", size = [0.1, 0.02, 0.04], edge = 0.02 }
translate = [0, -0.0151, 0]
friction = 0.5
material = "rubber"
gravity = [0, 0, 0]
[[body]]
name = "right"
kind = "solid"
shape = { type = "block", size = [0.1, 0.02, 0.04], edge = 0.02 }
translate = [0, 0.0151, 0]
friction = 0.5
material = "rubber"
gravity = [0, 0, 0]
[[pin]]
body = "left"
side = "y-min"
motion = { keyframes = [{ time = 0.3, translate = [0, 0.006, 0] }] }
[[pin]]
body = "right"
side = "y-max"
motion = { keyframes = [{ time = 0.3, translate = [0, -0.006, 0] }] }
[[pin]]
body = "strip"
side = "z-max"
end = 0.4
"#;

/// A sheet that two pins twist by two turns.
pub const TWISTED: &str = r#"
[simulation]
gravity = [0, 0, 0]
[[body]]
shape = { type = "sheet", size = [0.5, 0.25], edge = 0.02 }
material = { base = "cotton", stretch_damping = 0.05, bend_damping = 0.05 }
friction = 0.2
[[pin]]
side = "x-min"
motion = { axis = [1, 0, 0], keyframes = [{ time = 1.2, angle = -360, translate = [0.05, 0, 0] }] }
[[pin]]
side = "x-max"
motion = { axis = [1, 0, 0], keyframes = [{ time = 1.2, angle = 360, translate = [-0.05, 0, 0] }] }
"#;

/// Grains between two sheets on the ground.
pub const GRAINS: &str = r#"
[[body]]
name = "below"
shape = { type = "sheet", size = [0.2, 0.2], edge = 0.025 }
friction = 0.5
translate = [0, 0, 0.01]
[[body]]
name = "above"
shape = { type = "sheet", size = [0.2, 0.2], edge = 0.025 }
friction = 0.5
translate = [0, 0, 0.16]
[[body]]
name = "grains"
kind = "particles"
shape = { type = "grains", count = [4, 4, 3], spacing = 0.0165, jitter = 0.05 }
material = { base = "sand", radius = 0.004 }
friction = 0.5
translate = [0, 0, 0.08]
[[obstacle]]
shape = "half-space"
friction = 0.5
"#;
