//! What arrives in the pixels, on every driver that is installed.

/// Textures that other pictures are drawn on.
mod canvas;
/// Vulkan and GL give the same picture, and each the same picture twice.
mod drivers;
/// The glossy floor, hidden sky, patterns, one colour a face.
mod effects;
/// Lights, shadows, tone and colour.
mod light;
/// Where points land: fields of view, eyes, depth, edges.
mod projection;
/// Devices, scenes and measurements for the others.
mod support;
/// Textures and text.
mod surface;
