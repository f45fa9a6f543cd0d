//! The `bowling` program.
fn main() {}
