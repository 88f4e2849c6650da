//! The scenes that the sweeps change: a block and a sheet that fall on each other, and a taut sheet under a
//! weight.

use std::fmt::Write as _;

/// Stretch limit of all bodies, unless a case sets another.
pub const STRETCH_LIMIT: f64 = 1.05;

/// Thickness of cloth that turns Pa into N/m: that of the fabrics [m].
const CLOTH_THICKNESS: f64 = 3.18e-4;

/// What a sweep changes; the default is a scene of everyday size.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Time step [s].
    pub dt: f64,
    /// Factor on all lengths.
    pub size: f64,
    /// Contact distance [m]; none: the default of the scene, a tenth of its mean edge length.
    pub delta: Option<f64>,
    /// Minimum separation [m]; none: the default, a tenth of `delta`.
    pub min_separation: Option<f64>,
    /// Displacement of the scene along all three axes [m].
    pub origin: f64,
    /// Young's modulus of both bodies [Pa]; none: that of cotton and of rubber.
    pub stiffness: Option<f64>,
    /// Factor on the density of both bodies.
    pub density: f64,
    /// Factor on the density of the block alone.
    pub block_density: f64,
    /// Speed at which the upper body comes down [m/s].
    pub speed: f64,
    pub stretch_limit: f64,
    /// Number of squares along each side of the sheet.
    pub cells: usize,
}

impl Default for Setting {
    fn default() -> Self {
        Self {
            dt: 0.01,
            size: 1.0,
            delta: None,
            min_separation: None,
            origin: 0.0,
            stiffness: None,
            density: 1.0,
            block_density: 1.0,
            speed: 0.0,
            stretch_limit: STRETCH_LIMIT,
            cells: 10,
        }
    }
}

impl Setting {
    /// Whether the block can bear its own weight; if not, gravity crushes it, and nothing keeps its
    /// tetrahedra from being inverted.
    pub fn bears_its_weight(&self) -> bool {
        let weight = 1000.0 * self.density * self.block_density * 9.81 * self.length(3.0 * EDGE);
        weight < self.stiffness.unwrap_or(BLOCK_STIFFNESS)
    }
}

/// Young's modulus of the block, unless a case sets another [Pa].
const BLOCK_STIFFNESS: f64 = 1e5;

/// Mean edge length of the scenes at size 1 [m].
pub const EDGE: f64 = 0.04;

impl Setting {
    /// The tables `simulation`, `contact` and `solver.sleep`.
    pub fn head(&self, frames: usize) -> String {
        let mut text = format!(
            "[simulation]\ndt = {:e}\nframes = {frames}\n\n[solver.sleep]\nenabled = \
             false\n\n[contact]\nstretch_limit = {}\n",
            self.dt, self.stretch_limit
        );
        for (key, value) in [("delta", self.delta), ("min_separation", self.min_separation)] {
            if let Some(value) = value {
                let _ = writeln!(text, "{key} = {value:e}");
            }
        }
        text
    }

    /// A point of the scene at size 1, as TOML.
    pub fn at(&self, x: f64, y: f64, z: f64) -> String {
        let [x, y, z] = [x, y, z].map(|c| self.origin + c * self.size);
        format!("[{x:?}, {y:?}, {z:?}]")
    }

    pub fn length(&self, length: f64) -> f64 {
        length * self.size
    }

    /// A sheet of 10 edges a side about a point.
    pub fn sheet(&self, name: &str, at: [f64; 3], speed: f64) -> String {
        let side = self.length(10.0 * EDGE);
        let edge = side / self.cells as f64;
        let [x, y, z] = at;
        let stretch = self.stiffness.map_or(261.0, |young| young * CLOTH_THICKNESS);
        // The bending stiffness of a plate of that thickness, at a Poisson ratio of 0.243.
        let bend = self
            .stiffness
            .map_or(2.34e-6, |young| young * CLOTH_THICKNESS.powi(3) / (12.0 * (1.0 - 0.243 * 0.243)));
        format!(
            "\n[[body]]\nname = \"{name}\"\nfriction = 0.3\nshape = {{ type = \"sheet\", size = [{side:e}, \
             {side:e}], edge = {edge:e} }}\nrotate = [0.0, 0.0, 10.0]\ntranslate = {}\nvelocity = [0.0, 0.0, \
             {:?}]\n\
             material = {{ density = {:e}, stretch_stiffness = {stretch:e}, bend_stiffness = {bend:e} }}\n",
            self.at(x, y, z),
            -speed,
            0.15 * self.density,
        )
    }

    /// A soft block of 3 edges a side about a point.
    pub fn block(&self, name: &str, at: [f64; 3], speed: f64) -> String {
        let (side, edge) = (self.length(3.0 * EDGE), self.length(EDGE));
        let [x, y, z] = at;
        format!(
            "\n[[body]]\nname = \"{name}\"\nkind = \"solid\"\nfriction = 0.3\nshape = {{ type = \"block\", \
             size = [{side:e}, {side:e}, {side:e}], edge = {edge:e} }}\ntranslate = {}\n\
             velocity = [0.0, 0.0, {:?}]\nmaterial = {{ density = {:e}, young_modulus = {:e} }}\n",
            self.at(x, y, z),
            -speed,
            1000.0 * self.density * self.block_density,
            self.stiffness.unwrap_or(BLOCK_STIFFNESS),
        )
    }

    /// A box to stand on whose top is at z = 0.
    pub fn ground(&self) -> String {
        let (side, height) = (self.length(0.8), self.length(0.1));
        format!(
            "\n[[obstacle]]\nname = \"ground\"\nfriction = 0.3\nshape = {{ type = \"box\", size = [{side:e}, \
             {side:e}, {height:e}], edge = {:e} }}\ntranslate = {}\n",
            self.length(0.1),
            self.at(0.0, 0.0, -0.05),
        )
    }
}

/// A soft block falls on a box, and a sheet on both.
pub fn pile(setting: &Setting, frames: usize) -> String {
    let mut text = setting.head(frames);
    text += &setting.block("block", [0.013, 0.007, 0.1], 0.0);
    text += &setting.sheet("sheet", [0.0, 0.0, 0.2], setting.speed);
    text += &setting.ground();
    text
}

/// A sheet that is held along two sides, and a soft block that falls on it.
pub fn hammock(setting: &Setting, frames: usize) -> String {
    let mut text = setting.head(frames);
    text += &setting.sheet("sheet", [0.0, 0.0, 0.0], 0.0).replace("rotate = [0.0, 0.0, 10.0]\n", "");
    text += &setting.block("block", [0.013, 0.007, 0.1], setting.speed);
    for side in ["x-min", "x-max"] {
        let _ = write!(text, "\n[[pin]]\nbody = \"sheet\"\nside = \"{side}\"\n");
    }
    text
}
