//! Flow monitor: did every task of the millisecond run, once and in order?
//!
//! The watchdog may only be kicked with a [`Kick`], and only a whole millisecond gives one. A task that was left out,
//! ran twice or out of order spoils the millisecond, and all that follow: the watchdog then resets the ECU.

/// A task of the millisecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Task {
    /// The converters' samples and the panel's contacts were taken.
    Sample = 1,
    /// The controller has stepped.
    Control = 2,
    /// The coils' drivers have their values.
    Drive = 3,
    /// The bus was served.
    Bus = 4,
}

impl Task {
    /// All of them, in the order in which they have to run.
    pub const ALL: [Self; 4] = [Self::Sample, Self::Control, Self::Drive, Self::Bus];
}

/// Permission to kick the watchdog once.
#[derive(Debug, PartialEq, Eq)]
pub struct Kick(());

/// Watches the order of tasks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlowMonitor {
    /// Tasks of this millisecond so far.
    done: u8,
    spoilt: bool,
}

impl FlowMonitor {
    /// `task` has run.
    pub fn passed(&mut self, task: Task) {
        match task as u8 == self.done.saturating_add(1) {
            true => self.done = task as u8,
            false => self.spoilt = true,
        }
    }

    /// The end of the millisecond; permission if it was whole and no earlier one was spoilt.
    pub fn end(&mut self) -> Option<Kick> {
        self.spoilt |= self.done != Task::Bus as u8;
        self.done = 0;
        (!self.spoilt).then_some(Kick(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kicked(monitor: &mut FlowMonitor, tasks: &[Task]) -> bool {
        tasks.iter().for_each(|&task| monitor.passed(task));
        monitor.end().is_some()
    }

    #[test]
    fn only_all_tasks_in_order_kick_the_watchdog() {
        let mut monitor = FlowMonitor::default();
        assert!((0..1_000).all(|_| kicked(&mut monitor, &Task::ALL)));
        for left_out in 0..Task::ALL.len() {
            let mut tasks = Task::ALL.to_vec();
            tasks.remove(left_out);
            assert!(!kicked(&mut FlowMonitor::default(), &tasks), "{tasks:?}");
            let mut twice = Task::ALL.to_vec();
            twice.insert(left_out, Task::ALL[left_out]);
            assert!(!kicked(&mut FlowMonitor::default(), &twice), "{twice:?}");
        }
        for (first, second) in [(0, 1), (1, 2), (2, 3), (0, 3)] {
            let mut swapped = Task::ALL;
            swapped.swap(first, second);
            assert!(!kicked(&mut FlowMonitor::default(), &swapped));
        }
    }

    #[test]
    fn a_spoilt_millisecond_is_never_forgiven() {
        let mut monitor = FlowMonitor::default();
        assert!(!kicked(&mut monitor, &Task::ALL[..3]));
        assert!((0..1_000).all(|_| !kicked(&mut monitor, &Task::ALL)));
    }
}
