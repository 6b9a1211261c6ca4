//! The particles of recorded frames, in any order.

use std::io;
use std::sync::Arc;

use super::particles::Clouds;
use super::{Recording, Swarm};
use crate::scene::Scene;

/// Computes the particles of a recorded run, which may still be growing. Particles depend on the bodies of earlier frames, so consecutive
/// frames are fastest.
pub struct Swarms {
    clouds: Clouds,
    recording: Arc<Recording>,
    /// The number of the next frame to read.
    next: usize,
}

impl Swarms {
    /// Creates a reader that computes at most about `most` particles of each emitter at once: always the same ones, every n-th.
    #[must_use]
    pub fn thinned(scene: &Scene, recording: Arc<Recording>, most: f64) -> Swarms {
        Swarms { clouds: Clouds::thinned(scene, most), recording, next: 0 }
    }

    /// The stride n of each emitter: only every n-th of its particles is computed.
    #[must_use]
    pub fn strides(&self) -> &[u64] {
        self.clouds.strides()
    }

    /// True if the particles belong to this recording.
    #[must_use]
    pub fn are_of(&self, recording: &Arc<Recording>) -> bool {
        Arc::ptr_eq(&self.recording, recording)
    }

    /// Computes the particles of a frame, for each emitter in the order of the scene.
    ///
    /// # Errors
    /// If the frame is not recorded or cannot be read.
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
