//! Seconds of the phases of two-way steps, between time stamps of the device.

use crate::recording::Phase;

/// Most passes of a recording that are measured: each takes two time stamps.
const MOST_PASSES: usize = wgpu::QUERY_SET_MAX_QUERIES as usize / 2;

/// Seconds that a device spent on the phases of two-way steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseSeconds {
    seconds: [f64; Phase::ALL.len()],
}

impl PhaseSeconds {
    /// Those of a phase.
    pub fn of(&self, phase: Phase) -> f64 {
        self.seconds[phase as usize]
    }

    /// Those of all phases.
    pub fn total(&self) -> f64 {
        self.seconds.iter().sum()
    }
}

/// Puts time stamps around the passes of a recording, one pass per phase, and adds up what lies between them.
/// They are read with the results of the recording, so that the host does not wait for them.
#[derive(Debug)]
pub(super) struct PhaseClock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// Length of a tick [s].
    tick: f64,
    /// The phases of the passes of the present recording that are measured.
    passes: Vec<Phase>,
    seconds: PhaseSeconds,
}

impl PhaseClock {
    /// None if the device has no time stamps.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("phases"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * MOST_PASSES as u32,
        });
        let resolved = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("phases"),
            size: 16 * MOST_PASSES as u64,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let tick = 1e-9 * f64::from(queue.get_timestamp_period());
        Some(Self { queries, resolved, tick, passes: Vec::new(), seconds: PhaseSeconds::default() })
    }

    /// Begins a recording: what was measured and not read is forgotten.
    pub fn begin(&mut self) {
        self.passes.clear();
    }

    /// The time stamps of the next pass; none if it belongs to no phase, or there are too many.
    pub fn stamps(&mut self, phase: Option<Phase>) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let phase = phase.filter(|_| self.passes.len() < MOST_PASSES)?;
        let first = 2 * self.passes.len() as u32;
        self.passes.push(phase);
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Bytes of the time stamps of the recording.
    pub fn bytes(&self) -> u64 {
        16 * self.passes.len() as u64
    }

    /// Copies the time stamps to `staging`, from `offset` on.
    pub fn encode_read(&self, encoder: &mut wgpu::CommandEncoder, staging: &wgpu::Buffer, offset: u64) {
        if !self.passes.is_empty() {
            encoder.resolve_query_set(&self.queries, 0..2 * self.passes.len() as u32, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, staging, offset, self.bytes());
        }
    }

    /// Adds up the seconds of the passes, whose time stamps are `words`.
    pub fn add(&mut self, words: &[u32]) {
        for (phase, stamps) in self.passes.iter().zip(words.as_chunks::<4>().0) {
            let [begin, end] = [0, 2].map(|k| u64::from(stamps[k + 1]) << 32 | u64::from(stamps[k]));
            self.seconds.seconds[*phase as usize] += end.saturating_sub(begin) as f64 * self.tick;
        }
        self.passes.clear();
    }

    /// The seconds since the last call.
    pub fn take(&mut self) -> PhaseSeconds {
        std::mem::take(&mut self.seconds)
    }
}
