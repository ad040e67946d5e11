//! Task sequence monitor: checks that every task of a millisecond runs once and in order.
//!
//! The watchdog is reset with a [`Kick`], which only a complete millisecond yields. A task that is missing, runs twice
//! or runs out of order violates the sequence. A violation is permanent, so the watchdog resets the ECU.

/// A task of the millisecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Task {
    /// Samples of the converters and contacts of the panel.
    Sample = 1,
    /// Step of the controller.
    Control = 2,
    /// Output to the coil drivers.
    Drive = 3,
    /// Service of the bus.
    Bus = 4,
}

impl Task {
    /// All tasks, in the required order.
    pub const ALL: [Self; 4] = [Self::Sample, Self::Control, Self::Drive, Self::Bus];
}

/// Permission to reset the watchdog once.
#[derive(Debug, PartialEq, Eq)]
pub struct Kick(());

/// Monitors the sequence of tasks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TaskSequenceMonitor {
    /// Last task of this millisecond.
    done: u8,
    violated: bool,
}

impl TaskSequenceMonitor {
    /// `task` has run.
    pub fn passed(&mut self, task: Task) {
        if task as u8 == self.done.saturating_add(1) {
            self.done = task as u8
        } else {
            self.violated = true
        }
    }

    /// End of the millisecond; returns the permission if the sequence was complete and was never violated.
    pub fn end(&mut self) -> Option<Kick> {
        self.violated |= self.done != Task::Bus as u8;
        self.done = 0;
        (!self.violated).then_some(Kick(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kicked(monitor: &mut TaskSequenceMonitor, tasks: &[Task]) -> bool {
        tasks.iter().for_each(|&task| monitor.passed(task));
        monitor.end().is_some()
    }

    #[test]
    fn only_all_tasks_in_order_kick_the_watchdog() {
        let mut monitor = TaskSequenceMonitor::default();
        assert!((0..1_000).all(|_| kicked(&mut monitor, &Task::ALL)));
        for left_out in 0..Task::ALL.len() {
            let mut tasks = Task::ALL.to_vec();
            tasks.remove(left_out);
            assert!(
                !kicked(&mut TaskSequenceMonitor::default(), &tasks),
                "{tasks:?}"
            );
            let mut twice = Task::ALL.to_vec();
            twice.insert(left_out, Task::ALL[left_out]);
            assert!(
                !kicked(&mut TaskSequenceMonitor::default(), &twice),
                "{twice:?}"
            );
        }
        for (first, second) in [(0, 1), (1, 2), (2, 3), (0, 3)] {
            let mut swapped = Task::ALL;
            swapped.swap(first, second);
            assert!(!kicked(&mut TaskSequenceMonitor::default(), &swapped));
        }
    }

    #[test]
    fn a_violation_is_permanent() {
        let mut monitor = TaskSequenceMonitor::default();
        assert!(!kicked(&mut monitor, &Task::ALL[..3]));
        assert!((0..1_000).all(|_| !kicked(&mut monitor, &Task::ALL)));
    }
}
