//! Threads that process campaigns: together as many as there are cores.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use hitch_output::error::Error;

/// Calls `one` for each item, `jobs` of them at a time (one for each core without a number). The cores are shared out:
/// rayon uses `cores / jobs` threads, at least one, in each job. `RAYON_NUM_THREADS` limits the cores.
///
/// # Errors
/// If threads cannot be started.
pub fn each<I: Sync>(
    items: &[I],
    jobs: Option<usize>,
    one: &(impl Fn(&I) + Sync),
) -> Result<(), Error> {
    let cores = rayon::current_num_threads();
    let jobs = jobs.unwrap_or(cores).min(items.len());
    let next = AtomicUsize::new(0);
    let pools: Vec<rayon::ThreadPool> = (0..jobs)
        .map(|_| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads((cores / jobs).max(1));
            pool.build().map_err(|error| {
                Error::Failed(format!(
                    "threads cannot be started: {error}; give fewer --jobs"
                ))
            })
        })
        .collect::<Result<_, _>>()?;
    let work = || {
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            one(item);
        }
    };
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| pool.install(work));
        }
    });
    Ok(())
}

/// Runs the work on one campaign; a panic is an error of this campaign only.
pub fn guarded<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        Err(Error::Failed(
            "the program has a fault on this campaign; report it, with the campaign".to_owned(),
        ))
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn each_item_is_processed_once_with_its_share_of_the_cores() {
        let items: Vec<usize> = (0..50).collect();
        let seen = Mutex::new(Vec::new());
        each(&items, None, &|item| {
            assert_eq!(rayon::current_num_threads(), 1);
            seen.lock().unwrap().push(*item);
        })
        .unwrap();
        let mut seen = seen.into_inner().unwrap();
        seen.sort_unstable();
        assert_eq!(seen, items);
        let cores = rayon::current_num_threads();
        each(&items, Some(1), &|_| {
            assert_eq!(rayon::current_num_threads(), cores)
        })
        .unwrap();
        each(&[0; 0], None, &|_| ()).unwrap();
    }

    #[test]
    fn a_panic_is_an_error() {
        assert!(guarded(|| Ok(1)).is_ok());
        assert!(guarded::<()>(|| panic!("a test")).is_err());
    }
}
