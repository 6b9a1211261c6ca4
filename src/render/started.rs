//! A program that jabuka has started, and its end.

use std::io;
use std::marker::PhantomData;
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus};

use rustix::process::{Pid, Signal, kill_process_group};

/// A running program. Dropping this ends it, with all processes that it has started.
///
/// The system also ends the program when the thread that started it ends; nothing else works when jabuka is killed. So this
/// stays on its thread (it is not `Send`): no other thread can be left with a program that ends too early.
pub(super) struct Started {
    child: Child,
    exit: Option<ExitStatus>,
    on_this_thread: PhantomData<*const ()>,
}

impl Started {
    /// Starts a program as a process group of its own, so that an interrupt from the terminal does not reach it: POV-Ray would
    /// leave its state behind, and ffmpeg would end a film too early.
    ///
    /// # Errors
    /// If the system does not start it.
    pub(super) fn new(command: &mut Command) -> io::Result<Started> {
        let child = command.process_group(0).spawn()?;
        Ok(Started { child, exit: None, on_this_thread: PhantomData })
    }

    /// The number of the process, which is also that of its group.
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Takes its ends of the requested pipes, each only once.
    pub(super) fn pipes(&mut self) -> (Option<ChildStdin>, Option<ChildStdout>, Option<ChildStderr>) {
        (self.child.stdin.take(), self.child.stdout.take(), self.child.stderr.take())
    }

    /// Its exit status; `None` while it runs.
    ///
    /// # Errors
    /// If the system does not report it.
    pub(super) fn exit(&mut self) -> io::Result<Option<ExitStatus>> {
        if self.exit.is_none() {
            self.exit = self.child.try_wait()?;
        }
        Ok(self.exit)
    }

    /// Ends it, if it has not ended, with all processes that it has started: it may be a script that runs another program.
    pub(super) fn end(&mut self) -> Option<ExitStatus> {
        if self.exit.is_none() {
            // Killing a process that has ended already fails, which is as good.
            let _ = kill_process_group(Pid::from_child(&self.child), Signal::KILL);
            let _ = self.child.kill();
            self.exit = self.child.wait().ok();
        }
        self.exit
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        self.end();
    }
}
