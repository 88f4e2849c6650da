//! Integration tests that span several crates, in one binary.

// Manifests keep to the layers, no files import each other in a circle, named paths exist, and packages are whole.
mod dynamics_backends;
mod imports;
mod layers;
mod paths;
mod publishing;
// No step of the interior point baselines intersects.
mod interior_points;
// Degenerate contacts never intersect.
mod degenerate;
// Flights of a device do not either, nor where it binds little or pins are led into an obstacle.
mod bindings;
mod flights;
mod pins;
// The properties of the fuzz targets hold for seeded random bytes.
mod fuzz_bodies;
// Bodies in contact move as theory predicts, and none is crushed.
mod backends;
mod folds;
mod friction;
mod heaps;
mod momentum;
mod pressed;
mod slopes;
mod submissions;
// What the host does at the end of a call of a device.
mod ends;
