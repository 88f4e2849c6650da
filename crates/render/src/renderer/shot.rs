//! What the caller chooses for a picture: its quality, the camera and the surroundings.

use crate::Camera;
use bowknot_geometry::HalfSpace;

/// How much work goes into a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Number of lights that sample the key light. More give smoother penumbras, at proportional cost.
    pub key_lights: usize,
    /// Number of lights that sample the sky. More give smoother ambient occlusion, at proportional cost.
    pub sky_lights: usize,
    /// Points of each light that are looked up in penumbras, 1 to 4; neighboring pixels look up others. More
    /// give smoother penumbras of far casters.
    pub penumbra_taps: u32,
    /// Side of a shadow map [texels]. A larger one gives finer shadows; memory grows with its square, 2 bytes
    /// per texel and light.
    pub shadow_map: u32,
    /// Factor by which the picture is drawn larger in each direction and then reduced, in addition to the
    /// four samples per pixel.
    pub supersampling: u32,
}

impl Quality {
    /// For single pictures.
    pub const FINE: Self =
        Self { key_lights: 20, sky_lights: 60, penumbra_taps: 2, shadow_map: 1024, supersampling: 2 };
    /// For the frames of animations.
    pub const FAST: Self =
        Self { key_lights: 8, sky_lights: 24, penumbra_taps: 4, shadow_map: 768, supersampling: 1 };
}

/// The camera, the size of the picture and the ground around the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture [pixels].
    pub size: [u32; 2],
    /// Width of the strip at the right that is kept free for a legend [pixels].
    pub legend_width: u32,
    /// Planes that receive shadows; a plane is drawn only if the camera is in front of it.
    pub ground: Vec<HalfSpace>,
}

impl Shot {
    /// A shot without ground or legend.
    pub fn new(camera: Camera, size: [u32; 2]) -> Self {
        Self { camera, size, legend_width: 0, ground: Vec::new() }
    }
}
