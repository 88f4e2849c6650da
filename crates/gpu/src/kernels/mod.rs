//! The kernels, each with its table entry and its twin.
//!
//! Written from `shader/` by `cargo xtask twins`: change those files, not these.

// shader/backward
pub mod add_edge_curvature;
pub mod attainable_distances;
pub mod bin_rows;
pub mod coarse_factor;
pub mod coarse_rescale;
pub mod coarse_sums;
pub mod color_rows;
pub mod scan_buckets;
pub mod set_aims;
pub mod sort_rows;
pub mod store_multipliers;
pub mod sweep_edges;
pub mod sweep_rows;
pub mod unconstrained_minimum;

// shader/buffers
pub mod copy_words;
pub mod gather_nodes;
pub mod scan_blocks;
pub mod scan_counts;
pub mod scan_places;

// shader/call
pub mod begin_call;
pub mod list_near_pairs;
pub mod mark_near_pairs;
pub mod reset_step;
pub mod stop_rule;
pub mod warm_start;

// shader/elements
pub mod assemble_blocks;
pub mod bend_energy;
pub mod bend_gradient;
pub mod bend_hessian;
pub mod damped_tetrahedron_hessian;
pub mod diagonal_blocks;
pub mod gather_gradient;
pub mod membrane_energy;
pub mod membrane_gradient;
pub mod membrane_hessian;
pub mod node_energy;
pub mod strand_energy;
pub mod strand_gradient;
pub mod strand_hessian;
pub mod sum_energy;
pub mod tetrahedron_energy;
pub mod tetrahedron_gradient;
pub mod tetrahedron_hessian;

// shader/forward
pub mod advance_vertices;
pub mod block_residuals;
pub mod body_residuals;
pub mod cap_groups;
pub mod cap_travel;
pub mod limit_groups;
pub mod limit_step_sizes;
pub mod max_stretch;

// shader/geometry
pub mod classify_contacts;
pub mod desired_distances;
pub mod separate;

// shader/linear
pub mod cg_direction;
pub mod cg_step;
pub mod matrix_product;
pub mod schwarz_levels;
pub mod strand_product;

// shader/newton
pub mod add_solution;
pub mod block_momenta;
pub mod cg_residual;
pub mod cg_tolerance;
pub mod combine_guesses;
pub mod guess_products;
pub mod imposed_displacements;
pub mod initial_guesses;
pub mod reduce_trial;
pub mod regrid_positions;
pub mod residual_norms;
pub mod right_hand_side;
pub mod subtract_known_forces;
pub mod translate_blocks;
pub mod trial_positions;

// shader/preconditioner
pub mod coarsen_blocks;
pub mod domain_springs;
pub mod factor_diagonal;
pub mod galerkin_blocks;
pub mod group_frames;
pub mod invert_domains;

// shader/rows
pub mod compact_rows;
pub mod friction_rows;
pub mod hash_contacts;
pub mod linearize_rows;
pub mod merge_rows;
pub mod previous_displacements;
pub mod select_rows;

// shader/search
pub mod element_boxes;
pub mod inherit_states;
pub mod near_planes;
pub mod refit_boxes;
pub mod save_candidates;
pub mod traverse_tree;
pub mod update_trust_regions;

pub use add_edge_curvature::STAGE as ADD_EDGE_CURVATURE;
pub use attainable_distances::STAGE as ATTAINABLE_DISTANCES;
pub use bin_rows::STAGE as BIN_ROWS;
pub use coarse_factor::STAGE as COARSE_FACTOR;
pub use coarse_rescale::STAGE as COARSE_RESCALE;
pub use coarse_sums::STAGE as COARSE_SUMS;
pub use color_rows::STAGE as COLOR_ROWS;
pub use scan_buckets::STAGE as SCAN_BUCKETS;
pub use set_aims::STAGE as SET_AIMS;
pub use sort_rows::STAGE as SORT_ROWS;
pub use store_multipliers::STAGE as STORE_MULTIPLIERS;
pub use sweep_edges::STAGE as SWEEP_EDGES;
pub use sweep_rows::STAGE as SWEEP_ROWS;
pub use unconstrained_minimum::STAGE as UNCONSTRAINED_MINIMUM;
pub use copy_words::STAGE as COPY_WORDS;
pub use gather_nodes::STAGE as GATHER_NODES;
pub use scan_blocks::STAGE as SCAN_BLOCKS;
pub use scan_counts::STAGE as SCAN_COUNTS;
pub use scan_places::STAGE as SCAN_PLACES;
pub use begin_call::STAGE as BEGIN_CALL;
pub use list_near_pairs::STAGE as LIST_NEAR_PAIRS;
pub use mark_near_pairs::STAGE as MARK_NEAR_PAIRS;
pub use reset_step::STAGE as RESET_STEP;
pub use stop_rule::STAGE as STOP_RULE;
pub use warm_start::STAGE as WARM_START;
pub use assemble_blocks::STAGE as ASSEMBLE_BLOCKS;
pub use bend_energy::STAGE as BEND_ENERGY;
pub use bend_gradient::STAGE as BEND_GRADIENT;
pub use bend_hessian::STAGE as BEND_HESSIAN;
pub use damped_tetrahedron_hessian::STAGE as DAMPED_TETRAHEDRON_HESSIAN;
pub use diagonal_blocks::STAGE as DIAGONAL_BLOCKS;
pub use gather_gradient::STAGE as GATHER_GRADIENT;
pub use membrane_energy::STAGE as MEMBRANE_ENERGY;
pub use membrane_gradient::STAGE as MEMBRANE_GRADIENT;
pub use membrane_hessian::STAGE as MEMBRANE_HESSIAN;
pub use node_energy::STAGE as NODE_ENERGY;
pub use strand_energy::STAGE as STRAND_ENERGY;
pub use strand_gradient::STAGE as STRAND_GRADIENT;
pub use strand_hessian::STAGE as STRAND_HESSIAN;
pub use sum_energy::STAGE as SUM_ENERGY;
pub use tetrahedron_energy::STAGE as TETRAHEDRON_ENERGY;
pub use tetrahedron_gradient::STAGE as TETRAHEDRON_GRADIENT;
pub use tetrahedron_hessian::STAGE as TETRAHEDRON_HESSIAN;
pub use advance_vertices::STAGE as ADVANCE_VERTICES;
pub use block_residuals::STAGE as BLOCK_RESIDUALS;
pub use body_residuals::STAGE as BODY_RESIDUALS;
pub use cap_groups::STAGE as CAP_GROUPS;
pub use cap_travel::STAGE as CAP_TRAVEL;
pub use limit_groups::STAGE as LIMIT_GROUPS;
pub use limit_step_sizes::STAGE as LIMIT_STEP_SIZES;
pub use max_stretch::STAGE as MAX_STRETCH;
pub use classify_contacts::STAGE as CLASSIFY_CONTACTS;
pub use desired_distances::STAGE as DESIRED_DISTANCES;
pub use separate::STAGE as SEPARATE;
pub use cg_direction::STAGE as CG_DIRECTION;
pub use cg_step::STAGE as CG_STEP;
pub use matrix_product::STAGE as MATRIX_PRODUCT;
pub use schwarz_levels::STAGE as SCHWARZ_LEVELS;
pub use strand_product::STAGE as STRAND_PRODUCT;
pub use add_solution::STAGE as ADD_SOLUTION;
pub use block_momenta::STAGE as BLOCK_MOMENTA;
pub use cg_residual::STAGE as CG_RESIDUAL;
pub use cg_tolerance::STAGE as CG_TOLERANCE;
pub use combine_guesses::STAGE as COMBINE_GUESSES;
pub use guess_products::STAGE as GUESS_PRODUCTS;
pub use imposed_displacements::STAGE as IMPOSED_DISPLACEMENTS;
pub use initial_guesses::STAGE as INITIAL_GUESSES;
pub use reduce_trial::STAGE as REDUCE_TRIAL;
pub use regrid_positions::STAGE as REGRID_POSITIONS;
pub use residual_norms::STAGE as RESIDUAL_NORMS;
pub use right_hand_side::STAGE as RIGHT_HAND_SIDE;
pub use subtract_known_forces::STAGE as SUBTRACT_KNOWN_FORCES;
pub use translate_blocks::STAGE as TRANSLATE_BLOCKS;
pub use trial_positions::STAGE as TRIAL_POSITIONS;
pub use coarsen_blocks::STAGE as COARSEN_BLOCKS;
pub use domain_springs::STAGE as DOMAIN_SPRINGS;
pub use factor_diagonal::STAGE as FACTOR_DIAGONAL;
pub use galerkin_blocks::STAGE as GALERKIN_BLOCKS;
pub use group_frames::STAGE as GROUP_FRAMES;
pub use invert_domains::STAGE as INVERT_DOMAINS;
pub use compact_rows::STAGE as COMPACT_ROWS;
pub use friction_rows::STAGE as FRICTION_ROWS;
pub use hash_contacts::STAGE as HASH_CONTACTS;
pub use linearize_rows::STAGE as LINEARIZE_ROWS;
pub use merge_rows::STAGE as MERGE_ROWS;
pub use previous_displacements::STAGE as PREVIOUS_DISPLACEMENTS;
pub use select_rows::STAGE as SELECT_ROWS;
pub use element_boxes::STAGE as ELEMENT_BOXES;
pub use inherit_states::STAGE as INHERIT_STATES;
pub use near_planes::STAGE as NEAR_PLANES;
pub use refit_boxes::STAGE as REFIT_BOXES;
pub use save_candidates::STAGE as SAVE_CANDIDATES;
pub use traverse_tree::STAGE as TRAVERSE_TREE;
pub use update_trust_regions::STAGE as UPDATE_TRUST_REGIONS;

/// All of them.
#[cfg(test)]
pub static ALL: &[&crate::stages::Stage] = &[&ADD_EDGE_CURVATURE, &ATTAINABLE_DISTANCES, &BIN_ROWS, &COARSE_FACTOR, &COARSE_RESCALE, &COARSE_SUMS, &COLOR_ROWS, &SCAN_BUCKETS, &SET_AIMS, &SORT_ROWS, &STORE_MULTIPLIERS, &SWEEP_EDGES, &SWEEP_ROWS, &UNCONSTRAINED_MINIMUM, &COPY_WORDS, &GATHER_NODES, &SCAN_BLOCKS, &SCAN_COUNTS, &SCAN_PLACES, &BEGIN_CALL, &LIST_NEAR_PAIRS, &MARK_NEAR_PAIRS, &RESET_STEP, &STOP_RULE, &WARM_START, &ASSEMBLE_BLOCKS, &BEND_ENERGY, &BEND_GRADIENT, &BEND_HESSIAN, &DAMPED_TETRAHEDRON_HESSIAN, &DIAGONAL_BLOCKS, &GATHER_GRADIENT, &MEMBRANE_ENERGY, &MEMBRANE_GRADIENT, &MEMBRANE_HESSIAN, &NODE_ENERGY, &STRAND_ENERGY, &STRAND_GRADIENT, &STRAND_HESSIAN, &SUM_ENERGY, &TETRAHEDRON_ENERGY, &TETRAHEDRON_GRADIENT, &TETRAHEDRON_HESSIAN, &ADVANCE_VERTICES, &BLOCK_RESIDUALS, &BODY_RESIDUALS, &CAP_GROUPS, &CAP_TRAVEL, &LIMIT_GROUPS, &LIMIT_STEP_SIZES, &MAX_STRETCH, &CLASSIFY_CONTACTS, &DESIRED_DISTANCES, &SEPARATE, &CG_DIRECTION, &CG_STEP, &MATRIX_PRODUCT, &SCHWARZ_LEVELS, &STRAND_PRODUCT, &ADD_SOLUTION, &BLOCK_MOMENTA, &CG_RESIDUAL, &CG_TOLERANCE, &COMBINE_GUESSES, &GUESS_PRODUCTS, &IMPOSED_DISPLACEMENTS, &INITIAL_GUESSES, &REDUCE_TRIAL, &REGRID_POSITIONS, &RESIDUAL_NORMS, &RIGHT_HAND_SIDE, &SUBTRACT_KNOWN_FORCES, &TRANSLATE_BLOCKS, &TRIAL_POSITIONS, &COARSEN_BLOCKS, &DOMAIN_SPRINGS, &FACTOR_DIAGONAL, &GALERKIN_BLOCKS, &GROUP_FRAMES, &INVERT_DOMAINS, &COMPACT_ROWS, &FRICTION_ROWS, &HASH_CONTACTS, &LINEARIZE_ROWS, &MERGE_ROWS, &PREVIOUS_DISPLACEMENTS, &SELECT_ROWS, &ELEMENT_BOXES, &INHERIT_STATES, &NEAR_PLANES, &REFIT_BOXES, &SAVE_CANDIDATES, &TRAVERSE_TREE, &UPDATE_TRUST_REGIONS];
