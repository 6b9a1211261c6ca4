//! Reads the scene again whenever one of its files changes.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Instant;

use super::watch::{POLL_INTERVAL, Watched};
use crate::page::{Session, caught};

/// Reads the scene, and reads it again whenever one of its files changes, until `stop` is set. A panic becomes an error on the page, and
/// the next version is read all the same.
pub(super) fn follow(session: &Session, path: &Path, stop: &AtomicBool) {
    let mut watched = Watched::new(&[path.to_owned()]);
    loop {
        // The scene is read once more if a file may have changed while it was read.
        let mut again = false;
        let read = caught("reading the scene", || {
            watched = Watched::new(&watched.files());
            watched.add(&session.read());
            again = watched.are_young();
            Ok(())
        });
        if let Err(report) = read {
            session.fail(&report);
        }
        let read = Instant::now();
        loop {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            thread::sleep(POLL_INTERVAL);
            if watched.have_changed() {
                watched.settle();
                break;
            }
            if again && read.elapsed() > 2 * POLL_INTERVAL {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::sync::Arc;
    use std::time::Duration;

    use super::super::host::ServerHost;
    use super::*;
    use crate::Scene;
    use crate::cache::Cache;
    use crate::diagnostic::Report;
    use crate::page::State;
    use crate::scene::{Follow, Options};

    /// Makes a session for tests. Reading a scene with the title `panic` panics, and running a scene with the title `lost` panics. So does
    /// reporting an error about a mass.
    fn fragile(path: PathBuf) -> Arc<Session> {
        let read = move |options: &Options| {
            let mut scene = Scene::from_path_with(&path, options)?;
            match scene.title.as_deref() {
                Some("panic") => panic!("cannot read π"),
                Some("lost") => {
                    scene.camera.motion.follow = Some(Follow { body: 7, distance: None, lag: None });
                }
                _ => {}
            }
            Ok(scene)
        };
        let said = |report: &Report| assert!(!report.to_text(false).contains("mass"), "cannot report it");
        let host = ServerHost::with_reader(Cache::none(), said, read);
        Arc::new(Session::new(Options::default(), host))
    }

    #[test]
    fn after_a_panic_the_next_save_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let save = |title: &str| {
            let text = format!("title = '{title}'\n[body.ball]\nshape.sphere.radius = 1\n");
            std::fs::write(&path, text).unwrap();
        };
        let (session, stop) = (fragile(path.clone()), AtomicBool::new(false));
        let wait = |is_so: &dyn Fn(&State) -> bool| {
            let begun = Instant::now();
            while !is_so(&session.state()) {
                if begun.elapsed() > Duration::from_secs(120) {
                    // The thread that follows the scene must end, or the test would never.
                    stop.store(true, Ordering::Relaxed);
                    panic!("the session does not reach the state");
                }
                thread::sleep(Duration::from_millis(1));
            }
        };
        let of_run = |state: &State| state.runs.values().find_map(|run| run.problem.clone());
        save("panic");
        let problems = thread::scope(|scope| {
            scope.spawn(|| follow(&session, &path, &stop));
            wait(&|state| state.problem.is_some());
            let of_reading = session.state().problem;
            save("good");
            wait(&|state| state.problem.is_none() && state.current.is_some());
            save("lost");
            wait(&|state| of_run(state).is_some());
            let of_simulating = of_run(&session.state());
            save("good again");
            wait(&|state| of_run(state).is_none());
            save("heavy'\nbody.ball.mass = -1 #");
            wait(&|state| state.problem.as_ref().is_some_and(|problem| problem.contains("jabuka failed")));
            let of_reporting = session.state().problem;
            save("good at last");
            wait(&|state| state.problem.is_none());
            stop.store(true, Ordering::Relaxed);
            [of_reading, of_simulating, of_reporting].map(Option::unwrap_or_default)
        });
        let expected = [
            "reading the scene: cannot read π",
            "simulating: index out of bounds",
            "reading the scene: cannot report it",
        ];
        for (problem, expected) in problems.iter().zip(expected) {
            assert!(problem.contains(&format!("jabuka failed while {expected}")), "{problem}");
        }
    }
}
