//! Elements: the parts of deformable bodies that store elastic energy.
//!
//! | file | holds |
//! |---|---|
//! | [`element`] | the trait [`element::Element`]: energy, gradient and Hessian over a few nodes |
//! | [`filter`] | filters of negative curvatures |
//! | [`set`] | sets of elements of one kind and their assembly |
//! | [`triangle`], [`woven`] | stretching and shearing of cloth, isotropic and woven; [`membrane`]: what both share |
//! | [`bending`], [`shell`] | bending of cloth that is flat or curved at rest |
//! | [`tetrahedron`] | strain of solids, with a law of [`solid_law`] |
//! | [`quadratic`] | tetrahedra of linear strain, each four of constant strain |
//! | [`strand`] | stretching and bending of strands |
//! | [`rod`] | bending and twist of strands that resist twist |
//! | [`svd`] | singular values of 3 x 3 matrices |

pub(crate) mod bending;
pub(crate) mod element;
pub(crate) mod filter;
mod membrane;
pub(crate) mod quadratic;
pub(crate) mod rod;
pub(crate) mod set;
pub(crate) mod shell;
mod solid_law;
pub(crate) mod strand;
mod svd;
pub(crate) mod tetrahedron;
pub(crate) mod triangle;
pub(crate) mod woven;
