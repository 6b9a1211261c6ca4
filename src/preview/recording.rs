//! The frames of a run on disk, so that any of them can be read again, and memory does not grow with their number.
//!
//! A frame is there bit for bit, in little-endian 64-bit numbers, column by column:
//!
//! | column | numbers |
//! | --- | --- |
//! | time; kinetic, potential, total energy; work; drift; linear momentum; angular momentum | 12 |
//! | locations | 3 a body |
//! | orientations, x y z w | 4 a body |
//! | velocities | 3 a body |
//! | angular velocities | 3 a body |
//! | forces | 3 a body |

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DQuat, DVec3};

use crate::dynamics::Balance;
use crate::simulate::{BodyFrame, Frame, Past};

/// The numbers of a frame before those of its bodies.
pub(super) const HEAD: usize = 12;
/// The numbers of a body that say where it is.
pub(super) const POSE: usize = 7;
/// All numbers of a body.
const BODY: usize = 16;
/// The bytes of a number.
const NUMBER: usize = 8;

/// The frames of a run, from the first on. One writes, any number read.
pub(super) struct Recording {
    file: File,
    bodies: usize,
    recorded: AtomicUsize,
}

impl Recording {
    /// That of a run of so many frames which has not begun. The file has no name, and goes when the process does, however
    /// it ends.
    pub(super) fn new(bodies: usize, frames: usize) -> io::Result<Recording> {
        let folder = folder();
        let recording =
            Recording { file: tempfile::tempfile_in(&folder)?, bodies, recorded: AtomicUsize::new(0) };
        // To find out by filling the disk would hurt others.
        let space = rustix::fs::fstatvfs(&recording.file)?;
        let (needed, free) = (recording.offset(frames, 0), space.f_bavail.saturating_mul(space.f_frsize));
        if needed > free {
            let [needed, free] = [needed, free].map(|bytes| bytes.div_ceil(1_000_000));
            let message = format!("they take {needed} MB, and `{}` has room for {free} MB", folder.display());
            return Err(io::Error::new(io::ErrorKind::StorageFull, message));
        }
        Ok(recording)
    }

    /// How many frames there are.
    pub(super) fn recorded(&self) -> usize {
        self.recorded.load(Ordering::Acquire)
    }

    /// Adds the next frame.
    pub(super) fn push(&self, frame: &Frame) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(self.frame_bytes());
        let mut put =
            |numbers: &[f64]| numbers.iter().for_each(|n| bytes.extend_from_slice(&n.to_le_bytes()));
        let Balance { kinetic, potential, work, total, linear_momentum, angular_momentum, drift } =
            frame.balance;
        put(&[frame.time, kinetic, potential, total, work, drift]);
        put(&linear_momentum.to_array());
        put(&angular_momentum.to_array());
        frame.bodies.iter().for_each(|body| put(&body.location.to_array()));
        frame.bodies.iter().for_each(|body| put(&body.orientation.to_array()));
        frame.bodies.iter().for_each(|body| put(&body.velocity.to_array()));
        frame.bodies.iter().for_each(|body| put(&body.angular_velocity.to_array()));
        frame.bodies.iter().for_each(|body| put(&body.force.to_array()));
        let number = self.recorded();
        self.file.write_all_at(&bytes, self.offset(number, 0))?;
        self.recorded.store(number + 1, Ordering::Release);
        Ok(())
    }

    /// What comes before the bodies of a frame.
    pub(super) fn head(&self, frame: usize) -> io::Result<Vec<u8>> {
        self.bytes(frame, 0, HEAD)
    }

    /// Where all bodies are in a frame: the locations of all, then the orientations of all.
    pub(super) fn poses(&self, frame: usize) -> io::Result<Vec<u8>> {
        self.bytes(frame, HEAD, POSE * self.bodies)
    }

    /// The bytes of the poses of a frame.
    pub(super) fn pose_bytes(&self) -> usize {
        POSE * self.bodies * NUMBER
    }

    /// One body in a frame.
    pub(super) fn body(&self, frame: usize, id: usize) -> io::Result<BodyFrame> {
        let column = |before: usize, width: usize| {
            let place = HEAD + before * self.bodies + width * id;
            Ok::<Vec<f64>, io::Error>(numbers(&self.bytes(frame, place, width)?))
        };
        let vector = |numbers: &[f64]| DVec3::new(numbers[0], numbers[1], numbers[2]);
        let turn = column(3, 4)?;
        Ok(BodyFrame {
            id,
            location: vector(&column(0, 3)?),
            orientation: DQuat::from_xyzw(turn[0], turn[1], turn[2], turn[3]),
            velocity: vector(&column(7, 3)?),
            angular_velocity: vector(&column(10, 3)?),
            force: vector(&column(13, 3)?),
        })
    }

    /// A frame as it was, but for its past.
    pub(super) fn frame(&self, index: usize) -> io::Result<Frame> {
        let all = numbers(&self.bytes(index, 0, HEAD + BODY * self.bodies)?);
        let vector = |at: usize| DVec3::new(all[at], all[at + 1], all[at + 2]);
        let body = |id: usize| {
            let column = |before: usize, width: usize| HEAD + before * self.bodies + width * id;
            let turn = column(3, 4);
            BodyFrame {
                id,
                location: vector(column(0, 3)),
                orientation: DQuat::from_xyzw(all[turn], all[turn + 1], all[turn + 2], all[turn + 3]),
                velocity: vector(column(7, 3)),
                angular_velocity: vector(column(10, 3)),
                force: vector(column(13, 3)),
            }
        };
        let balance = Balance {
            kinetic: all[1],
            potential: all[2],
            total: all[3],
            work: all[4],
            drift: all[5],
            linear_momentum: vector(6),
            angular_momentum: vector(9),
        };
        let bodies = (0..self.bodies).map(body).collect();
        Ok(Frame { index, time: all[0], bodies, balance, past: Past::default() })
    }

    fn bytes(&self, frame: usize, from: usize, count: usize) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; count * NUMBER];
        self.file.read_exact_at(&mut bytes, self.offset(frame, from))?;
        Ok(bytes)
    }

    fn frame_bytes(&self) -> usize {
        (HEAD + BODY * self.bodies) * NUMBER
    }

    fn offset(&self, frame: usize, number: usize) -> u64 {
        frame as u64 * self.frame_bytes() as u64 + (number * NUMBER) as u64
    }
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    let number = |chunk: &[u8]| chunk.try_into().map_or(f64::NAN, f64::from_le_bytes);
    bytes.chunks_exact(NUMBER).map(number).collect()
}

/// Where large files go: the usual folder is in memory on some systems.
fn folder() -> PathBuf {
    let large = PathBuf::from("/var/tmp");
    match std::env::var_os("TMPDIR") {
        None if large.is_dir() => large,
        _ => std::env::temp_dir(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use crate::simulate::Frames;

    #[test]
    fn a_frame_that_is_read_again_is_the_same_bit_for_bit() {
        let scene = Scene::parse(
            "
            [simulation]
            duration = 0.2
            gravity = [0, -9.81, 0]
            [body.box]
            shape.box.size = [3, 1, 2]
            angular_velocity = [0.1, 0.2, 5]
            [body.ball]
            shape.sphere.radius = 1
            velocity = [1, 2, 3]
            ",
        )
        .unwrap();
        let recording = Recording::new(2, 6).unwrap();
        let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
        frames.iter().for_each(|frame| recording.push(frame).unwrap());
        assert_eq!(recording.recorded(), 6);
        for frame in frames.iter().rev() {
            assert_eq!(recording.frame(frame.index).unwrap(), *frame);
            for body in &frame.bodies {
                assert_eq!(recording.body(frame.index, body.id).unwrap(), *body);
            }
            let poses = numbers(&recording.poses(frame.index).unwrap());
            assert_eq!(poses[3..6], frame.bodies[1].location.to_array());
            assert_eq!(poses[10..14], frame.bodies[1].orientation.to_array());
            assert_eq!(numbers(&recording.head(frame.index).unwrap())[0], frame.time);
        }
        assert!(recording.frame(6).is_err());
    }

    #[test]
    fn what_no_disk_holds_is_refused_before_it_is_begun() {
        let error = Recording::new(1_000_000, 1_000_000).err().unwrap();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        assert!(error.to_string().starts_with("they take 128000096 MB"), "{error}");
    }
}
