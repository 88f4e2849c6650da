//! Which frames go into the page, and their bytes.

use crate::bodies::Body;
use crate::codec::{Grid, Predictor, encode_indices, pack as deflate};
use crate::error::ReportError;
use crate::options::ReportOptions;
use bowknot_io::FrameSource;
use bowknot_io::Mesh;

/// Largest size of all positions once unpacked in the browser [bytes]: what compresses well still needs
/// memory there.
const MAX_UNPACKED: u64 = 600_000_000;
/// Bytes of base64 per vertex and frame with which the first stride is guessed: less than what runs were seen
/// to take (2 to 5), so that no frame is left out for a guess.
const HOPED_BYTES: f64 = 1.5;

/// The frames as the page holds them.
#[derive(Debug)]
pub(super) struct Pack {
    pub(super) bodies: Vec<Body>,
    /// For each body its elements, then what does not move of it; then one string a frame. Base64.
    pub(super) elements: Vec<Elements>,
    pub(super) frames: Vec<String>,
    /// Indices of the frames shown, ascending.
    pub(super) shown: Vec<usize>,
    pub(super) stride: usize,
    /// Largest error of a position [m].
    pub(super) error: f64,
}

/// The elements of a body, packed; its positions if it never moves.
#[derive(Clone, Debug, Default)]
pub(super) struct Elements {
    pub(super) triangles: String,
    pub(super) strands: String,
    pub(super) particles: String,
    pub(super) still: String,
}

impl Elements {
    fn len(&self) -> u64 {
        (self.triangles.len() + self.strands.len() + self.particles.len() + self.still.len()) as u64
    }
}

/// Packs as many frames as the budget takes. `fixed` is what the rest of the page needs [bytes].
pub(super) fn pack(
    frames: &FrameSource,
    mut bodies: Vec<Body>,
    options: &ReportOptions,
    fixed: u64,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Pack, ReportError> {
    let count = frames.len();
    let mut read = 0;
    let mut planned = 2 * count;
    let mut reading = |index: usize, planned: usize| -> Result<Mesh, ReportError> {
        let mesh = frames.read(index)?;
        read += 1;
        progress(read, planned.max(read));
        Ok(mesh)
    };

    // The boxes come from all frames, so that they do not depend on which are shown.
    let first = reading(0, planned)?.positions;
    bodies.iter_mut().for_each(|body| body.take(&first, &first));
    for index in 1..count {
        let positions = reading(index, planned)?.positions;
        if positions.len() != first.len() {
            let (found, expected) = (positions.len(), first.len());
            return Err(ReportError::Mismatch { path: frames.path(index).to_owned(), found, expected });
        }
        bodies.iter_mut().for_each(|body| body.take(&positions, &first));
    }
    let grids: Vec<Grid> = bodies.iter().map(|body| Grid::new(body.low, body.high)).collect();
    // The squares that stand for half-spaces are wide, and their corners nobody looks at.
    let seen = bodies.iter().zip(&grids).filter(|(body, _)| body.kind != "half-space");
    let error = seen.map(|(_, grid)| grid.error()).fold(0.0, f64::max);

    let elements: Vec<Elements> = bodies
        .iter()
        .zip(&grids)
        .map(|(body, grid)| {
            let particles: Vec<[u32; 1]> = body.particles.iter().map(|&v| [v]).collect();
            let mut still = Vec::new();
            if !body.moves {
                Predictor::default().encode(quantized(body, grid, &first), &mut still);
            }
            let packed = |bytes: Vec<u8>| if bytes.is_empty() { String::new() } else { deflate(&bytes) };
            Elements {
                triangles: packed(encode_indices(&body.triangles)),
                strands: packed(encode_indices(&body.strands)),
                particles: packed(encode_indices(&particles)),
                still: packed(still),
            }
        })
        .collect();

    let moving: u64 = bodies.iter().filter(|b| b.moves).map(|b| b.vertices.len() as u64).sum();
    let budget = options.max_bytes.saturating_sub(fixed + elements.iter().map(Elements::len).sum::<u64>());
    let too_large = |stride: usize, remedy| {
        let frames = shown(count, stride).len();
        ReportError::TooLarge { frames, stride, budget: options.max_bytes, remedy }
    };
    let guess = (moving * count as u64) as f64 * HOPED_BYTES / budget.max(1) as f64;
    let memory = (6 * moving * count as u64).div_ceil(MAX_UNPACKED) as usize;
    let mut stride = options.stride.unwrap_or((guess.ceil() as usize).max(memory).clamp(1, count));
    loop {
        let shown = shown(count, stride);
        planned = planned.max(read_so_far(count, &shown));
        let mut predictors = vec![Predictor::default(); bodies.len()];
        let mut packed: Vec<String> = Vec::new();
        let mut size = 0;
        for &index in &shown {
            let positions = reading(index, planned)?.positions;
            let mut bytes = Vec::new();
            for ((body, grid), predictor) in bodies.iter().zip(&grids).zip(&mut predictors) {
                if body.moves {
                    predictor.encode(quantized(body, grid, &positions), &mut bytes);
                }
            }
            packed.push(deflate(&bytes));
            size += packed.last().map_or(0, String::len) as u64 + 1;
            if size > budget {
                break;
            }
        }
        if size <= budget {
            return Ok(Pack { bodies, elements, frames: packed, shown, stride, error });
        }
        if options.stride.is_some() {
            return Err(too_large(stride, "raise the largest size of the page, or the stride"));
        }
        if shown.len() <= 2 {
            return Err(too_large(stride, "raise the largest size of the page"));
        }
        // What was packed within the budget tells how many frames it takes; frames further apart are larger.
        let taken = (packed.len() - 1).max(1) as f64;
        let needed = shown.len() as f64 / taken * 1.1;
        stride = ((stride as f64 * needed).ceil() as usize).clamp(stride + 1, count.max(stride + 1));
        planned += count.div_ceil(stride) + 1;
    }
}

fn read_so_far(count: usize, shown: &[usize]) -> usize {
    count + shown.len()
}

/// Every `stride`-th frame, and the last.
fn shown(count: usize, stride: usize) -> Vec<usize> {
    let mut shown: Vec<usize> = (0..count).step_by(stride).collect();
    if shown.last() != Some(&(count - 1)) {
        shown.push(count - 1);
    }
    shown
}

fn quantized(body: &Body, grid: &Grid, positions: &[bowknot_geometry::Point]) -> Vec<[u16; 3]> {
    body.vertices.iter().map(|&v| grid.quantize(&positions[v as usize])).collect()
}
