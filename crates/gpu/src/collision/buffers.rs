//! The buffers of a scene on an engine, and how they grow: by a quarter more than is needed, but not beyond
//! what the device binds.

use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::layout::{
    Ball, Block, BlockSum, Bucket, Candidate, Control, EdgeCluster, EdgeLimit, Late, OldRow, PairFriction,
    PairState, Plane, Row, Separation, Vertex,
};
use crate::recording::BufferId;
use bytemuck::Pod;

/// Candidates per vertex for which there is room at first.
const FIRST_CANDIDATES: usize = 16;

/// Contact rows per vertex for which there is room at first.
const FIRST_ROWS: usize = 4;

/// Places per vertex of the table of contacts.
const CONTACT_PLACES: usize = 4;

/// Numbers of what the buffers hold.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    pub vertices: usize,
    pub groups: usize,
    pub edges: usize,
    pub triangles: usize,
    pub planes: usize,
    /// Pairs of sides with a coefficient of friction of their own.
    pub pair_frictions: usize,
    pub limits: usize,
    /// Clusters of limited edges, their vertices and colors.
    pub clusters: [usize; 3],
    /// Words of the adjacency.
    pub adjacency: usize,
    /// Blocks of vertices.
    pub blocks: usize,
    /// Rows of the search: query elements of all kinds.
    pub rows: usize,
    /// Buckets of contact rows.
    pub buckets: usize,
}

/// Buffers that all stages share.
#[derive(Clone, Copy, Debug)]
pub struct Buffers {
    /// Candidates that fit into their list.
    pub capacity: usize,
    /// Candidates of the time before a search for which there is room, and candidates that can be selected.
    pub old_capacity: usize,
    pub selection_capacity: usize,
    /// Contact rows for which there is room.
    pub row_capacity: usize,
    pub positions: BufferId,
    pub targets: BufferId,
    /// Where the vertices were at the start of the time step, from where slip counts.
    pub slip_start: BufferId,
    pub vertices: BufferId,
    pub edges: BufferId,
    pub triangles: BufferId,
    pub planes: BufferId,
    pub pair_frictions: BufferId,
    pub paths: BufferId,
    pub alphas: BufferId,
    pub group_caps: BufferId,
    pub group_alphas: BufferId,
    pub balls: BufferId,
    pub control: BufferId,
    /// What each step of a submission came to, and the workgroups of the dispatches of all but its first
    /// step.
    pub reports: BufferId,
    pub arguments: BufferId,
    /// Where the candidates of each row of the search begin, and where the last ones end; sums by block.
    pub starts: BufferId,
    pub blocks: BufferId,
    pub candidates: BufferId,
    pub separations: BufferId,
    pub states: BufferId,
    pub rest: BufferId,
    pub old_rows: BufferId,
    pub old_elements: BufferId,
    pub old_states: BufferId,
    pub adjacency: BufferId,
    pub vertex_blocks: BufferId,
    pub block_sums: BufferId,
    pub limits: BufferId,
    /// Clusters of limited edges, their vertices and the ends of their colors.
    pub clusters: BufferId,
    pub cluster_vertices: BufferId,
    pub cluster_colors: BufferId,
    pub proximal: BufferId,
    pub displacements: BufferId,
    /// What rows without a color move each vertex by; zeros between two uses.
    pub pushes: BufferId,
    /// Displacement of the last step, and the factor on the proximal weight.
    pub swings: BufferId,
    /// Progress of the prescribed vertices.
    pub late: BufferId,
    /// Where the vertices go in this step.
    pub aims: BufferId,
    /// Sums of the coarse correction by block; its factor, and by how much the multipliers may still grow.
    pub coarse_sums: BufferId,
    pub coarse_factor: BufferId,
    /// Who has the row of a contact. Its size, a power of two, does not depend on what there is room for.
    pub contacts: BufferId,
    pub contact_places: usize,
    pub selection: SelectionBuffers,
    pub rows: RowBuffers,
}

/// Which candidates have a row, one entry per candidate.
#[derive(Clone, Copy, Debug)]
pub struct SelectionBuffers {
    /// Whether each candidate has a row, then the places of the rows by candidate, and where the last one
    /// ends; sums by block.
    pub starts: BufferId,
    pub blocks: BufferId,
}

/// Buffers of the contact rows.
#[derive(Clone, Copy, Debug)]
pub struct RowBuffers {
    pub rows: BufferId,
    /// The pair of each row.
    pub pairs: BufferId,
    /// Rows in the order of their buckets and colors.
    pub order: BufferId,
    /// Colors in use at each vertex, rows that wait for a color, and the keys of the rows that hold each
    /// vertex.
    pub colors_in_use: BufferId,
    pub waiting: BufferId,
    pub claims: BufferId,
    /// The buckets, and their numbers of rows before they are sorted.
    pub buckets: BufferId,
    pub tally: BufferId,
    /// Where each color of a bucket ends in the order, from the place where the bucket begins.
    pub color_ends: BufferId,
}

impl Buffers {
    /// Buffers of zeros.
    ///
    /// # Errors
    /// The device has no memory.
    pub fn new(engine: &mut impl Engine, sizes: &Sizes) -> Result<Self, GpuError> {
        let &Sizes { vertices, groups, edges, triangles, planes, limits, adjacency, blocks, rows, .. } =
            sizes;
        let [clusters, cluster_vertices, cluster_colors] = sizes.clusters;
        let capacity = most_candidates(engine).min((FIRST_CANDIDATES * vertices).max(64));
        let row_capacity = most_rows(engine).min((FIRST_ROWS * vertices).max(64));
        let contact_places = (CONTACT_PLACES * vertices).next_power_of_two();
        Ok(Self {
            capacity,
            old_capacity: capacity,
            selection_capacity: capacity,
            row_capacity,
            positions: engine.buffer("positions", 4 * vertices)?,
            rest: engine.buffer("rest positions", 4 * vertices)?,
            targets: engine.buffer("targets", 4 * vertices)?,
            slip_start: engine.buffer("start of slip", 4 * vertices)?,
            vertices: engine.buffer("vertices", words::<Vertex>(vertices + planes))?,
            edges: engine.buffer("edges", 2 * edges)?,
            triangles: engine.buffer("triangles", 4 * triangles)?,
            planes: engine.buffer("planes", words::<Plane>(planes))?,
            pair_frictions: engine
                .buffer("friction of pairs", words::<PairFriction>(sizes.pair_frictions))?,
            paths: engine.buffer("paths", 4 * vertices)?,
            alphas: engine.buffer("step sizes", vertices)?,
            group_caps: engine.buffer("group caps", groups)?,
            group_alphas: engine.buffer("group step sizes", groups)?,
            balls: engine.buffer("trust regions", words::<Ball>(vertices))?,
            control: engine.buffer("control", words::<Control>(1))?,
            reports: engine.buffer("reports", words::<Control>(1))?,
            arguments: engine.buffer("arguments", 0)?,
            starts: engine.buffer("starts", rows + 1)?,
            blocks: engine.buffer("blocks", rows.div_ceil(kernels::SCAN_COUNTS.workgroup))?,
            candidates: engine.buffer("candidates", words::<Candidate>(capacity))?,
            separations: engine.buffer("separations", words::<Separation>(capacity))?,
            states: engine.buffer("states of pairs", words::<PairState>(capacity))?,
            old_rows: engine.buffer("old rows", words::<OldRow>(rows))?,
            old_elements: engine.buffer("old partners", capacity)?,
            old_states: engine.buffer("old states of pairs", words::<PairState>(capacity))?,
            adjacency: engine.buffer("adjacency", adjacency)?,
            vertex_blocks: engine.buffer("blocks of vertices", words::<Block>(blocks))?,
            block_sums: engine.buffer("sums of blocks", words::<BlockSum>(blocks))?,
            limits: engine.buffer("edge limits", words::<EdgeLimit>(limits))?,
            clusters: engine.buffer("clusters of edges", words::<EdgeCluster>(clusters))?,
            cluster_vertices: engine.buffer("vertices of clusters", cluster_vertices)?,
            cluster_colors: engine.buffer("colors of clusters", cluster_colors)?,
            proximal: engine.buffer("proximal weights", vertices)?,
            swings: engine.buffer("swings", 4 * vertices)?,
            displacements: engine.buffer("displacements", 4 * vertices)?,
            pushes: engine.buffer("pushes", 4 * vertices)?,
            late: engine.buffer("progress", words::<Late>(vertices))?,
            aims: engine.buffer("aims", 4 * vertices)?,
            coarse_sums: engine.buffer("coarse sums", 2 * kernels::COARSE_FACTOR.workgroup)?,
            coarse_factor: engine.buffer("coarse factor", 2)?,
            contacts: engine.buffer("contacts", contact_places)?,
            contact_places,
            selection: SelectionBuffers::new(engine, capacity)?,
            rows: RowBuffers::new(engine, sizes, row_capacity)?,
        })
    }

    /// Makes room for so many candidates and a quarter more; what was there is lost. The rows of the step
    /// stay, and what was kept from before the search.
    ///
    /// # Errors
    /// The device has no memory, or does not bind as much.
    pub fn grow(&mut self, engine: &mut impl Engine, candidates: usize) -> Result<(), GpuError> {
        if candidates > most_candidates(engine) {
            // The largest buffer is refused before the others are gone.
            engine.buffer("separations", words::<Separation>(candidates))?;
        }
        for old in [self.candidates, self.separations, self.states] {
            engine.free(old);
        }
        let capacity = with_reserve(candidates, most_candidates(engine));
        self.capacity = capacity;
        self.candidates = engine.buffer("candidates", words::<Candidate>(capacity))?;
        self.separations = engine.buffer("separations", words::<Separation>(capacity))?;
        self.states = engine.buffer("states of pairs", words::<PairState>(capacity))?;
        tracing::debug!(candidates, "buffers grew");
        Ok(())
    }

    /// Makes room for submissions of so many steps, in which `dispatches` can be left out.
    ///
    /// # Errors
    /// The device has no memory.
    pub fn make_room_for_steps(
        &mut self,
        engine: &mut impl Engine,
        steps: usize,
        dispatches: usize,
    ) -> Result<(), GpuError> {
        for (buffer, label, words) in [
            (&mut self.reports, "reports", words::<Control>(steps)),
            (&mut self.arguments, "arguments", 3 * dispatches),
        ] {
            if engine.words(*buffer) < words {
                engine.free(*buffer);
                *buffer = engine.buffer(label, words)?;
            }
        }
        Ok(())
    }

    /// Makes room for so many contact rows and a quarter more. Those of the last step are lost.
    ///
    /// # Errors
    /// The device has no memory, or does not bind as much.
    pub fn grow_rows(
        &mut self,
        engine: &mut impl Engine,
        sizes: &Sizes,
        rows: usize,
    ) -> Result<(), GpuError> {
        self.rows.free(engine);
        self.row_capacity = with_reserve(rows, most_rows(engine));
        self.rows = RowBuffers::new(engine, sizes, self.row_capacity)?;
        tracing::debug!(rows, "buffers of rows grew");
        Ok(())
    }

    /// Makes room for a step that is not made again: to select among all present candidates, and to keep
    /// these.
    ///
    /// # Errors
    /// The device has no memory.
    pub fn make_room_for_step(&mut self, engine: &mut impl Engine) -> Result<(), GpuError> {
        if self.selection_capacity < self.capacity {
            self.selection.free(engine);
            self.selection_capacity = self.capacity;
            self.selection = SelectionBuffers::new(engine, self.capacity)?;
        }
        if self.old_capacity < self.capacity {
            engine.free(self.old_elements);
            engine.free(self.old_states);
            self.old_capacity = self.capacity;
            self.old_elements = engine.buffer("old partners", self.capacity)?;
            self.old_states = engine.buffer("old states of pairs", words::<PairState>(self.capacity))?;
        }
        Ok(())
    }
}

impl SelectionBuffers {
    fn new(engine: &mut impl Engine, capacity: usize) -> Result<Self, GpuError> {
        Ok(Self {
            starts: engine.buffer("starts of rows", capacity + 1)?,
            blocks: engine.buffer("blocks of rows", capacity.div_ceil(kernels::SCAN_COUNTS.workgroup))?,
        })
    }

    fn free(&self, engine: &mut impl Engine) {
        let &Self { starts, blocks } = self;
        [starts, blocks].into_iter().for_each(|buffer| engine.free(buffer));
    }
}

impl RowBuffers {
    fn new(engine: &mut impl Engine, sizes: &Sizes, capacity: usize) -> Result<Self, GpuError> {
        Ok(Self {
            rows: engine.buffer("contact rows", words::<Row>(capacity))?,
            pairs: engine.buffer("pairs of rows", words::<Candidate>(capacity))?,
            order: engine.buffer("order of rows", capacity)?,
            colors_in_use: engine.buffer("colors in use", 4 * sizes.vertices)?,
            waiting: engine.buffer("rows without a color", 2 * capacity)?,
            claims: engine.buffer("claims", sizes.vertices)?,
            buckets: engine.buffer("buckets of rows", words::<Bucket>(sizes.buckets))?,
            tally: engine.buffer("rows of buckets", sizes.buckets)?,
            color_ends: engine.buffer("ends of colors", capacity)?,
        })
    }

    fn free(&self, engine: &mut impl Engine) {
        let &Self { rows, pairs, order, colors_in_use, waiting, claims, buckets, tally, color_ends } = self;
        [rows, pairs, order, colors_in_use, waiting, claims, buckets, tally, color_ends]
            .into_iter()
            .for_each(|buffer| engine.free(buffer));
    }
}

/// Most candidates for which an engine has room: the largest of the buffers with an entry per candidate
/// decides.
pub fn most_candidates(engine: &impl Engine) -> usize {
    engine.most_words() / words::<Separation>(1)
}

/// Most contact rows for which it has room.
fn most_rows(engine: &impl Engine) -> usize {
    engine.most_words() / words::<Row>(1)
}

/// A quarter more entries than are needed, if `most` allows them.
fn with_reserve(needed: usize, most: usize) -> usize {
    needed.max(most.min(needed + needed / 4))
}

/// Words of 32 bits of so many entries.
pub fn words<T: Pod>(count: usize) -> usize {
    count * size_of::<T>() / 4
}
