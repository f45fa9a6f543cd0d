use std::path::PathBuf;

/// What can go wrong in the renderer, each in one sentence that says what to do.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// No driver offers what was asked for.
    #[error("no graphics driver for {tried} was found: on Debian or Ubuntu, install {packages}")]
    NoDriver {
        /// The interfaces that were tried, in words.
        tried: &'static str,
        /// The packages that bring a software driver.
        packages: &'static str,
    },
    /// A driver is there but would not give a device.
    #[error("the graphics driver {adapter} refused to start: {reason}")]
    Device {
        /// The driver's own name for the device.
        adapter: String,
        /// What it said.
        reason: String,
    },
    /// A mesh file cannot be used.
    #[error("{}{}: {reason}", path.display(), line.map(|n| format!(":{n}")).unwrap_or_default())]
    MeshFile {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1, where one is to blame.
        line: Option<usize>,
        /// What is wrong.
        reason: String,
    },
    /// A mesh given in memory cannot be used.
    #[error("the mesh cannot be used: {0}")]
    Mesh(String),
    /// A texture file cannot be used.
    #[error("{}: {reason}", path.display())]
    TextureFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A texture given in memory cannot be used.
    #[error("the texture cannot be used: {0}")]
    Texture(String),
    /// A scene asks for something that cannot be drawn.
    #[error("the scene cannot be drawn: {0}")]
    Scene(String),
    /// A view does not describe an eye.
    #[error("the view cannot be drawn: {0}")]
    View(String),
    /// An image size or a setting that the device cannot give.
    #[error("{0}")]
    Unsupported(String),
    /// The window cannot be drawn to.
    #[error("the window cannot be drawn to: {0}")]
    Window(String),
    /// An image could not be brought back from the device.
    #[error("the image could not be read back from the graphics device: {0}")]
    Readback(String),
}
