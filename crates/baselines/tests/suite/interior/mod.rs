//! Interior point methods other than the two-way one.

mod descent;
mod forms;
mod impacts;
mod newton;
mod objective;
