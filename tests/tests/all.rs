//! Integration tests that span several crates, in one binary.

// Manifests keep to the layers, and named paths exist.
mod layers;
mod paths;
// The generators of hard states do what they say.
mod generators;
// No step of the forward step, alone or within the two-way loop, ever intersects.
mod safety;
// Nor does one of the interior point methods to compare with.
mod interior_points;
// What the fuzz targets check holds for seeded random bytes.
mod fuzz_bodies;
// Contact moves bodies as theory has it, and crushes none.
mod folds;
mod friction;
mod momentum;
mod slopes;
