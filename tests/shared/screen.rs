use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use image::RgbImage;
use tempfile::TempDir;

use super::process::Process;

/// A screen whose picture lies in a file, for one test alone.
pub struct Screen {
    pub _server: Process,
    display: String,
    folder: TempDir,
}

impl Screen {
    /// Starts it, of so many pixels.
    ///
    /// # Panics
    /// When Xvfb does not start.
    pub fn open([width, height]: [u32; 2]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut command = Command::new("Xvfb");
        command
            .args(["-displayfd", "1", "-nolisten", "tcp"])
            // Its socket belongs to this network, and not to a folder that screens of other networks share: there it
            // would take the place of one with the same number.
            .args(["-nolisten", "unix"])
            .args(["-screen", "0", &format!("{width}x{height}x24"), "-fbdir"])
            .arg(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        let mut server = Process::start("Xvfb (package xvfb)", &mut command);
        let output = server.child().stdout.take().expect("piped");
        let mut number = String::new();
        BufReader::new(output)
            .read_line(&mut number)
            .expect("Xvfb writes text");
        assert!(number.ends_with('\n'), "Xvfb ends without a display");
        Self {
            _server: server,
            display: format!(":{}", number.trim()),
            folder,
        }
    }

    /// What programs find it by.
    pub fn display(&self) -> &str {
        &self.display
    }

    /// One `xdotool` call, real events through the X server: what it says.
    ///
    /// # Panics
    /// When it fails.
    pub fn act(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .output()
            .expect("xdotool starts: install the package xdotool, as scripts/test.sh does");
        assert!(
            output.status.success(),
            "xdotool {arguments:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// The picture on the screen: XWD, 32 bits per pixel, blue first.
    ///
    /// # Panics
    /// When Xvfb keeps none.
    pub fn shot(&self) -> RgbImage {
        let mut bytes = Vec::new();
        File::open(self.folder.path().join("Xvfb_screen0"))
            .and_then(|mut file| file.read_to_end(&mut bytes))
            .expect("Xvfb keeps its picture in a file");
        let word = |at: usize| {
            u32::from_be_bytes(bytes[4 * at..4 * at + 4].try_into().expect("four bytes")) as usize
        };
        // XWDFile.h: header size, .., width (4), height (5), .., bytes per line (12), .., colours (19) of 12 bytes each.
        let (header, width, height, stride, colours) =
            (word(0), word(4), word(5), word(12), word(19));
        let pixels = header + 12 * colours;
        RgbImage::from_fn(width as u32, height as u32, |x, y| {
            let at = pixels + y as usize * stride + 4 * x as usize;
            image::Rgb([bytes[at + 2], bytes[at + 1], bytes[at]])
        })
    }
}

/// Different colours on a picture, counted roughly: an empty or broken window has few.
pub fn colours(picture: &RgbImage) -> usize {
    let coarse = picture.pixels().map(|pixel| pixel.0.map(|c| c >> 4));
    coarse.collect::<std::collections::BTreeSet<_>>().len()
}
