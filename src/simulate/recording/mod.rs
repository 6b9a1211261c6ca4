//! The recording of a run: the states at its moments, which are the frames and the requested times between them. They can be read in any
//! order.
//!
//! A [`Store`] keeps the moments in pages, for example in a file, so that memory does not grow with the run. A page is full after 32 moments
//! or about 1 MB, and can be read without the pages before it. A run can be read while it is still being recorded.

mod codec;
mod events;
mod store;
#[cfg(test)]
mod tests;

use std::io;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard};

use self::codec::{Decoder, Encoder, damaged};
use super::Frame;
use super::simulation::Entry;
use crate::physics::{BodySnapshot, Snapshot};

pub use codec::Counts;
pub use store::{MemoryStore, Store};

/// The number of moments after which a page is full.
const MOMENTS_PER_PAGE: usize = 32;
/// The number of bytes from which on a page is full.
const FULL_PAGE_BYTES: usize = 1 << 20;

/// All recorded moments of a run. One thread appends moments; any number of readers may read them.
pub struct Recording {
    counts: Counts,
    encoder: Mutex<Encoder>,
    contents: RwLock<Contents>,
    store: Box<dyn Store>,
}

/// The index of a recording, with the page that is not full yet.
#[derive(Default)]
struct Contents {
    /// The time of each moment, s, in increasing order.
    times: Vec<f64>,
    /// The number of the moment at which each frame was recorded.
    frames: Vec<u32>,
    /// The number of the first moment in each stored page.
    pages: Vec<u32>,
    /// The encoded moments that do not fill a page yet.
    open: Vec<u8>,
    /// The number of the first moment in `open`.
    first: usize,
}

impl Recording {
    /// Creates an empty recording of a run with these numbers of bodies, joints and impact counts.
    pub fn new(counts: Counts, store: Box<dyn Store>) -> Recording {
        let (encoder, contents) = (Mutex::new(Encoder::new(counts)), RwLock::default());
        Recording { counts, encoder, contents, store }
    }

    /// Opens a complete recording from its [index](Self::index). The store must hold all of its pages.
    ///
    /// # Errors
    /// If the index is invalid.
    pub fn with_index(counts: Counts, index: &[u8], store: Box<dyn Store>) -> io::Result<Recording> {
        let contents = RwLock::new(Contents::from_bytes(index)?);
        Ok(Recording { counts, encoder: Mutex::new(Encoder::new(Counts::default())), contents, store })
    }

    /// Opens a recording as [`with_index`](Self::with_index) does, but one to which further moments can be appended.
    ///
    /// # Errors
    /// If the index is invalid.
    pub(super) fn to_be_continued(
        counts: Counts,
        index: &[u8],
        store: Box<dyn Store>,
    ) -> io::Result<Recording> {
        let recording = Recording::with_index(counts, index, store)?;
        Ok(Recording { encoder: Mutex::new(Encoder::new(counts)), ..recording })
    }

    /// Appends the next moment.
    pub(super) fn push(&self, entry: &Entry) -> io::Result<()> {
        let Entry { frame, snapshot, .. } = entry;
        let mut encoder = self.encoder();
        let mut bytes = Vec::new();
        encoder.encode(entry, &mut bytes);
        let mut contents = self.contents.write().unwrap_or_else(PoisonError::into_inner);
        let number = contents.times.len();
        contents.times.push(snapshot.time);
        if frame.is_some() {
            contents.frames.push(u32_of(number));
        }
        contents.open.append(&mut bytes);
        if number + 1 - contents.first >= MOMENTS_PER_PAGE || contents.open.len() >= FULL_PAGE_BYTES {
            self.close_page(&mut contents, &mut encoder)?;
        }
        Ok(())
    }

    /// Stores the last page, even if it is not full, and returns the index of the recording as bytes. The index and the store are
    /// sufficient to open the recording again.
    ///
    /// # Errors
    /// If the store has no room for the page.
    pub fn index(&self) -> io::Result<Vec<u8>> {
        let mut encoder = self.encoder();
        let mut contents = self.contents.write().unwrap_or_else(PoisonError::into_inner);
        if !contents.open.is_empty() {
            self.close_page(&mut contents, &mut encoder)?;
        }
        Ok(contents.to_bytes())
    }

    fn close_page(&self, contents: &mut Contents, encoder: &mut Encoder) -> io::Result<()> {
        self.store.put(&contents.open)?;
        let first = u32_of(contents.first);
        contents.pages.push(first);
        contents.open.clear();
        contents.first = contents.times.len();
        encoder.begin_page();
        Ok(())
    }

    /// The number of frames recorded so far.
    pub fn frames(&self) -> usize {
        self.contents().frames.len()
    }

    /// Creates a reader at the first moment.
    pub fn read(self: &Arc<Self>) -> Reader {
        let decoder = Decoder::new(self.counts);
        Reader {
            recording: Arc::clone(self),
            next: 0,
            page: None,
            decoder,
            at: 0,
            known: None,
            #[cfg(test)]
            decoded: 0,
        }
    }

    fn encoder(&self) -> MutexGuard<'_, Encoder> {
        self.encoder.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn contents(&self) -> RwLockReadGuard<'_, Contents> {
        self.contents.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// The number of the moment at a time (s). `None` if no moment was recorded at this time.
    pub(super) fn moment_at(&self, time: f64) -> Option<usize> {
        self.contents().times.binary_search_by(|other| other.total_cmp(&time)).ok()
    }

    /// The number of the moment at which a frame was recorded. `None` if the frame was not recorded.
    pub(super) fn moment_of(&self, frame: usize) -> Option<usize> {
        self.contents().frames.get(frame).map(|&moment| moment as usize)
    }

    /// The number of the last frame at or before a moment.
    pub(super) fn frame_at(&self, moment: usize) -> usize {
        let contents = self.contents();
        contents.frames.partition_point(|&frame| frame as usize <= moment).saturating_sub(1)
    }

    /// Returns the page that contains a moment. The last page holds the moments written so far.
    fn page_of(&self, moment: usize) -> io::Result<Page> {
        let contents = self.contents();
        if moment >= contents.first {
            let moments = contents.first..contents.times.len();
            return Ok(Page { moments, bytes: contents.open.as_slice().into() });
        }
        let next = contents.pages.partition_point(|&first| first as usize <= moment);
        let number = next.checked_sub(1).ok_or_else(damaged)?;
        let end = contents.pages.get(next).map_or(contents.first, |&end| end as usize);
        let moments = contents.pages[number] as usize..end;
        drop(contents);
        Ok(Page { moments, bytes: self.store.page(number)? })
    }
}

impl Contents {
    fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let counts = [self.times.len(), self.frames.len(), self.pages.len()];
        counts.iter().for_each(|count| bytes.extend((*count as u64).to_le_bytes()));
        self.times.iter().for_each(|time| bytes.extend(time.to_le_bytes()));
        self.frames.iter().chain(&self.pages).for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes
    }

    fn from_bytes(bytes: &[u8]) -> io::Result<Contents> {
        let (counts, rest) = bytes.split_at_checked(24).ok_or_else(damaged)?;
        let counts: Vec<usize> = counts
            .as_chunks::<8>()
            .0
            .iter()
            .map(|chunk| usize::try_from(u64::from_le_bytes(*chunk)).unwrap_or(usize::MAX))
            .collect();
        let (times, rest) = rest.split_at_checked(counts[0].saturating_mul(8)).ok_or_else(damaged)?;
        let (frames, pages) = rest.split_at_checked(counts[1].saturating_mul(4)).ok_or_else(damaged)?;
        if pages.len() != counts[2].saturating_mul(4) {
            return Err(damaged());
        }
        let numbers =
            |bytes: &[u8]| bytes.as_chunks::<4>().0.iter().map(|chunk| u32::from_le_bytes(*chunk)).collect();
        let times: Vec<f64> =
            times.as_chunks::<8>().0.iter().map(|chunk| f64::from_le_bytes(*chunk)).collect();
        let first = times.len();
        Ok(Contents { times, frames: numbers(frames), pages: numbers(pages), open: Vec::new(), first })
    }
}

/// A page of a recording, as it was when it was read. The last page of a growing recording may have become longer since.
struct Page {
    moments: Range<usize>,
    bytes: Arc<[u8]>,
}

/// Reads a recording moment by moment, from any position.
pub struct Reader {
    recording: Arc<Recording>,
    next: usize,
    /// The page that contains the last moment read. `None` before the first.
    page: Option<Page>,
    decoder: Decoder,
    /// The number of the moment that the decoder reads next.
    at: usize,
    /// The index of the only body that the decoder has followed in this page. `None` if the decoder has followed all bodies.
    known: Option<usize>,
    #[cfg(test)]
    decoded: usize,
}

impl Reader {
    /// Moves to a moment, given by its number.
    pub(super) fn seek(&mut self, moment: usize) {
        self.next = moment;
    }

    /// Moves to a frame, given by its number. Returns false if the frame was not recorded.
    pub(super) fn seek_frame(&mut self, frame: usize) -> bool {
        let moment = self.recording.moment_of(frame);
        self.next = moment.unwrap_or(usize::MAX);
        moment.is_some()
    }

    /// The number of the next moment.
    pub(super) fn position(&self) -> usize {
        self.next
    }

    /// Reads the next moment. Returns `None` at the end of the recorded part.
    pub(super) fn entry(&mut self) -> io::Result<Option<Entry>> {
        self.advance(None, Decoder::decode)
    }

    /// Reads the state of the world at a frame.
    ///
    /// # Errors
    /// If the frame was not recorded or cannot be read.
    pub fn frame(&mut self, frame: usize) -> io::Result<Snapshot> {
        if !self.seek_frame(frame) {
            return Err(damaged());
        }
        Ok(self.entry()?.ok_or_else(damaged)?.snapshot)
    }

    /// Reads a frame with its impact counts, without particles, trails and ghosts.
    ///
    /// # Errors
    /// If the frame was not recorded or cannot be read.
    pub fn seen(&mut self, frame: usize) -> io::Result<Frame> {
        if !self.seek_frame(frame) {
            return Err(damaged());
        }
        Ok(Frame::of_entry(frame, self.entry()?.ok_or_else(damaged)?))
    }

    /// Reads a frame with only one of its bodies, and returns this body separately, too. The body is `None` if it is absent. This is
    /// faster than reading all bodies, especially for consecutive frames.
    ///
    /// # Errors
    /// If the frame was not recorded or cannot be read.
    pub fn body(&mut self, frame: usize, body: usize) -> io::Result<(Frame, Option<BodySnapshot>)> {
        if !self.seek_frame(frame) {
            return Err(damaged());
        }
        let found =
            self.advance(Some(body), |decoder, page| decoder.decode_one(page, body).map(|(entry, _)| entry))?;
        let seen = Frame::of_entry(frame, found.ok_or_else(damaged)?);
        let body = seen.bodies.first().copied();
        Ok((seen, body))
    }

    fn advance(
        &mut self,
        known: Option<usize>,
        mut decode: impl FnMut(&mut Decoder, &[u8]) -> io::Result<Entry>,
    ) -> io::Result<Option<Entry>> {
        let moment = self.next;
        let count = self.recording.contents().times.len();
        if moment >= count {
            return Ok(None);
        }
        if !self.page.as_ref().is_some_and(|page| page.moments.contains(&moment)) {
            let page = self.recording.page_of(moment)?;
            // If the page has only become longer, the decoder keeps its position in the page.
            if self.page.as_ref().is_none_or(|before| before.moments.start != page.moments.start) {
                self.at = page.moments.start;
                self.decoder.begin_page();
            }
            self.page = Some(page);
        }
        let Some(Page { moments, bytes }) = &self.page else { return Err(damaged()) };
        if self.at > moment || self.known != known {
            self.known = known;
            self.at = moments.start;
            self.decoder.begin_page();
        }
        loop {
            let entry = decode(&mut self.decoder, bytes)?;
            self.at += 1;
            #[cfg(test)]
            {
                self.decoded += 1;
            }
            if self.at > moment {
                self.next = moment + 1;
                return Ok(Some(entry));
            }
        }
    }
}

#[allow(clippy::cast_possible_truncation, reason = "the check of a scene limits the number of frames")]
fn u32_of(number: usize) -> u32 {
    number as u32
}
