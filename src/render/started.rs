//! A child process, which ends together with the thread that started it.

use std::io;
use std::marker::PhantomData;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus};

use crate::system::Family;

/// A running child process. Dropping it kills the process, and all processes of its family.
///
/// On Linux, the system also kills the child when the thread that started it ends; on Windows, when jabuka ends. This works even if jabuka itself is killed. So this type is not
/// `Send`: it stays on its thread, and no other thread can be left with a child that ends too early.
pub(super) struct Started {
    child: Child,
    family: Family,
    exit: Option<ExitStatus>,
    on_this_thread: PhantomData<*const ()>,
}

impl Started {
    /// Starts a program in a family of its own, so that an interrupt from the terminal does not reach it. An interrupted POV-Ray
    /// would leave state files behind, and an interrupted ffmpeg would cut the film short.
    ///
    /// # Errors
    /// If the program cannot be started.
    pub(super) fn new(command: &mut Command) -> io::Result<Started> {
        let (child, family) = Family::start(command)?;
        Ok(Started { child, family, exit: None, on_this_thread: PhantomData })
    }

    /// Returns the process id, which is also the id of its process group on Unix.
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Takes jabuka's ends of the pipes to standard input, output and error. Each is `Some` only once, and only if the command requested
    /// the pipe.
    pub(super) fn pipes(&mut self) -> (Option<ChildStdin>, Option<ChildStdout>, Option<ChildStderr>) {
        (self.child.stdin.take(), self.child.stdout.take(), self.child.stderr.take())
    }

    /// Returns the exit status of the process. `None` while it is running.
    ///
    /// # Errors
    /// If the system does not report the status.
    pub(super) fn exit(&mut self) -> io::Result<Option<ExitStatus>> {
        if self.exit.is_none() {
            self.exit = self.child.try_wait()?;
        }
        Ok(self.exit)
    }

    /// Kills all processes of the family, since the program may be a script that runs another program. Returns the exit status.
    pub(super) fn end(&mut self) -> Option<ExitStatus> {
        if self.exit.is_none() {
            self.exit = self.family.end(&mut self.child);
        }
        self.exit
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        self.end();
    }
}
