//! Texts painted into pictures: at once, or by a thread with a device of its own for a frame that must not wait.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use anyhow::{Context, Result, anyhow};
use renderer::{BackendChoice, Gpu, Picture, RenderError, RgbaImage, TextPainter};

/// Something to paint.
type Job = Box<dyn FnOnce(&mut TextPainter) + Send>;

/// How long the thread's end is waited for.
const LONGEST_END: Duration = Duration::from_secs(2);

/// Who asks a thread to paint texts; it ends with the last of them.
#[derive(Clone)]
pub struct Scribe {
    jobs: Sender<Job>,
}

/// The end of that thread: a program that ends while a device is being closed may be ended by its driver instead.
pub struct LastWord(Receiver<()>);

impl LastWord {
    /// Waits until the thread has closed its device, as long as it does not take long.
    pub fn wait(self) {
        // Nothing is ever sent: the sender goes with the thread.
        let _ = self.0.recv_timeout(LONGEST_END);
    }
}

impl Scribe {
    /// Opens a device and begins.
    ///
    /// # Errors
    /// When there is no device, or the system has no thread left.
    pub fn begin() -> Result<(Self, LastWord)> {
        let gpu = Gpu::new(BackendChoice::Auto).context("nothing can paint the texts")?;
        let (jobs, due) = channel::<Job>();
        let (end, ended) = channel();
        std::thread::Builder::new()
            .name("scribe".to_owned())
            .spawn(move || {
                let mut painter = TextPainter::new(&gpu);
                due.into_iter().for_each(|job| job(&mut painter));
                drop((painter, gpu));
                drop::<Sender<()>>(end);
            })
            .context("cannot start the thread that paints texts")?;
        Ok((Self { jobs }, LastWord(ended)))
    }
}

/// Who paints.
enum Painter {
    /// Whoever asks, before they go on; got ready for the first text.
    Here(Box<(Gpu, Option<TextPainter>)>),
    /// Somebody else, meanwhile.
    Apart(Scribe),
}

/// Pictures of texts, each asked for under a key and had when it is done.
pub struct Letters<K> {
    painter: Painter,
    tell: Sender<(K, Result<Picture, RenderError>)>,
    told: Receiver<(K, Result<Picture, RenderError>)>,
}

impl<K: Send + 'static> Letters<K> {
    /// Painted at once, on this device.
    pub fn here(gpu: &Gpu) -> Self {
        Self::of(Painter::Here(Box::new((gpu.clone(), None))))
    }

    /// Painted meanwhile.
    pub fn apart(scribe: &Scribe) -> Self {
        Self::of(Painter::Apart(scribe.clone()))
    }

    fn of(painter: Painter) -> Self {
        let (tell, told) = channel();
        Self {
            painter,
            tell,
            told,
        }
    }

    /// Has a text painted.
    ///
    /// # Errors
    /// When the thread that paints is no more.
    pub fn ask(
        &mut self,
        key: K,
        paint: impl FnOnce(&mut TextPainter) -> Result<RgbaImage, RenderError> + Send + 'static,
    ) -> Result<()> {
        let tell = self.tell.clone();
        let job = move |painter: &mut TextPainter| {
            let picture = paint(painter).map(Picture::from);
            // Who asked may be gone.
            let _ = tell.send((key, picture));
        };
        match &mut self.painter {
            Painter::Here(here) => {
                let (gpu, painter) = &mut **here;
                job(painter.get_or_insert_with(|| TextPainter::new(gpu)));
            }
            Painter::Apart(scribe) => {
                let sent = scribe.jobs.send(Box::new(job));
                sent.map_err(|_| anyhow!("the thread that paints texts has ended"))?;
            }
        }
        Ok(())
    }

    /// The next that is done, in the order in which they were asked for; never waits.
    ///
    /// # Errors
    /// When it could not be painted.
    pub fn done(&mut self) -> Result<Option<(K, Picture)>> {
        match self.told.try_recv() {
            Ok((key, picture)) => Ok(Some((key, picture.context("cannot paint a text")?))),
            Err(_) => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::RecvTimeoutError;

    /// The thread is held up: whoever asks goes on, and has the pictures in order once it is free.
    #[test]
    fn who_asks_does_not_wait() {
        let (scribe, last_word) = Scribe::begin().expect("a driver");
        let mut letters = Letters::apart(&scribe);
        let (free, held) = channel::<()>();
        letters
            .ask(1, move |_| {
                let ended = held.recv_timeout(Duration::from_secs(60));
                assert_eq!(ended, Err(RecvTimeoutError::Disconnected));
                Ok(RgbaImage::new(4, 2))
            })
            .expect("it lives");
        letters
            .ask(2, |painter| painter.caption("Red", 64))
            .expect("it lives");
        assert!(letters.done().expect("nothing failed").is_none());
        drop(free);
        let mut sizes = Vec::new();
        while sizes.len() < 2 {
            // Waits for the thread, whose end would be an error.
            let (key, picture) = letters.told.recv().expect("it lives");
            sizes.push((key, picture.expect("painted").size()[0]));
        }
        assert_eq!(sizes, [(1, 4), (2, 64)]);
        drop((scribe, letters));
        last_word.wait();
    }

    #[test]
    fn a_text_that_cannot_be_painted_is_an_error_of_who_has_it() {
        let gpu = Gpu::new(BackendChoice::Noop).expect("the test backend needs no driver");
        let mut letters = Letters::here(&gpu);
        letters
            .ask((), |_| Err(RenderError::Unsupported("none".to_owned())))
            .expect("asked for");
        assert!(letters.done().is_err());
        assert!(letters.done().expect("that was all").is_none());
    }
}
