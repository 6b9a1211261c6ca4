use glam::DVec3;

use super::*;
use crate::simulate::ImpactCounts;

/// The number of test frames, which fill more than two pages. Body 0 moves and body 1 rests.
const FRAMES: usize = 2 * MOMENTS_PER_PAGE + 5;

fn push(recording: &Recording, frame: usize) {
    let body = |id, x| BodySnapshot { id, location: DVec3::X * x, ..BodySnapshot::default() };
    let x = f64::from(u32_of(frame));
    let snapshot = Snapshot { time: x, bodies: vec![body(0, x), body(1, 7.0)], ..Snapshot::default() };
    let (impacts, counts) = (Vec::new(), ImpactCounts::default());
    recording.push(&Entry { frame: Some(frame), snapshot, impacts, counts }).unwrap();
}

/// A moment holds only the changes since the previous one. A reader that follows a growing recording must still not decode the page from
/// its start for each frame.
#[test]
fn to_follow_a_run_frame_by_frame_decodes_each_moment_once() {
    let recording =
        Arc::new(Recording::new(Counts { bodies: 2, joints: 0, impacts: 0 }, Box::<MemoryStore>::default()));
    let (mut all, mut one) = (recording.read(), recording.read());
    for frame in 0..FRAMES {
        push(&recording, frame);
        let x = f64::from(u32_of(frame));
        // The frames of a page are readable before the page is full.
        assert_eq!(all.frame(frame).unwrap().bodies[0].location.x, x);
        assert_eq!(one.body(frame, 0).unwrap().1.unwrap().location.x, x);
    }
    assert_eq!((all.decoded, one.decoded), (FRAMES, FRAMES));
}

/// A reader that has decoded only one body must restart the page to read the others.
#[test]
fn one_body_and_all_can_be_read_in_any_order() {
    let recording =
        Arc::new(Recording::new(Counts { bodies: 2, joints: 0, impacts: 0 }, Box::<MemoryStore>::default()));
    (0..FRAMES).for_each(|frame| push(&recording, frame));
    let mut reader = recording.read();
    for frame in [3, 40, 41, 2, 68, 0, 35] {
        let x = f64::from(u32_of(frame));
        assert_eq!(reader.body(frame, 1).unwrap().1.unwrap().location.x, 7.0);
        assert_eq!(reader.body(frame, 0).unwrap().1.unwrap().location.x, x);
        let bodies = reader.frame(frame).unwrap().bodies;
        assert_eq!(bodies.iter().map(|body| body.location.x).collect::<Vec<_>>(), [x, 7.0]);
    }
}
