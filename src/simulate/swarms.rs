//! The particles of recorded frames, in any order.

use std::io;
use std::sync::Arc;

use super::particles::Clouds;
use super::{Recording, Swarm};
use crate::scene::Scene;

/// The particles of the frames of a run that is recorded or being recorded. They depend on the bodies of earlier frames, so consecutive
/// frames are fastest.
pub struct Swarms {
    clouds: Clouds,
    recording: Arc<Recording>,
    /// The next frame.
    next: usize,
}

impl Swarms {
    /// Keeps at most about this many particles of each emitter at once: every n-th, always the same ones.
    #[must_use]
    pub fn thinned(scene: &Scene, recording: Arc<Recording>, most: f64) -> Swarms {
        Swarms { clouds: Clouds::thinned(scene, most), recording, next: 0 }
    }

    /// For each emitter n, where every n-th particle is kept.
    #[must_use]
    pub fn strides(&self) -> &[u64] {
        self.clouds.strides()
    }

    /// Whether they belong to this recording.
    #[must_use]
    pub fn are_of(&self, recording: &Arc<Recording>) -> bool {
        Arc::ptr_eq(&self.recording, recording)
    }

    /// The particles of a frame, for each emitter in the order of the scene.
    ///
    /// # Errors
    /// If the frame is not recorded, or cannot be read.
    pub fn at(&mut self, frame: usize) -> io::Result<Vec<Swarm>> {
        if !self.clouds.go_on_to(frame, self.next) {
            self.next = self.clouds.first_frame(frame);
            self.clouds.begin_at(self.next);
        }
        let mut reader = self.recording.read();
        while self.next <= frame {
            self.clouds.note(&reader.seen(self.next)?);
            self.next += 1;
        }
        Ok(self.clouds.now())
    }
}
