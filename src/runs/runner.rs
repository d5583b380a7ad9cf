//! What a process that runs trials says of itself, in a file beside them: for whoever wants to know how far they are. Nothing depends on it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::experiment::{Shard, replace};

const ENDING: &str = ".runner";
/// How long a process waits before it says what is new.
const NEWS: Duration = Duration::from_secs(1);
/// How often it says that it is there, in turns of [`NEWS`].
const SIGN_OF_LIFE: u32 = 10;
/// Seconds after which a process that has said nothing is taken for dead.
const SILENT_S: f64 = 60.0;

/// A process that runs trials, as it says of itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Runner {
    /// Which trials it runs: number and number of shards.
    pub shard: [u32; 2],
    /// The machine that it is on.
    pub host: String,
    /// Its number there.
    pub process: u32,
    /// How many trials it runs at a time.
    pub jobs: usize,
    /// When it began, seconds since 1970 by its machine's clock.
    pub began_s: f64,
    /// When it last said something, by the same clock.
    pub heard_s: f64,
    /// How many trials it has finished.
    pub finished: u32,
    /// Wall time that these took, seconds of a thread.
    pub wall_s: f64,
    /// How many trials it has left, those under way among them.
    pub left: u32,
    /// What it is running.
    pub under_way: Vec<UnderWay>,
    /// Why it stopped, if a trial failed.
    pub failed: Option<FailedTrial>,
    /// Whether it has ended.
    pub ended: bool,
}

/// A trial that is being run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnderWay {
    /// The place of its scenario: 0, or the setting's in a study.
    pub setting: usize,
    /// Its number.
    pub trial: u32,
    /// When it began, seconds since 1970.
    pub began_s: f64,
}

/// A trial that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailedTrial {
    /// The place of its scenario: 0, or the setting's in a study.
    pub setting: usize,
    /// Its number.
    pub trial: u32,
    /// Why.
    pub reason: String,
}

/// How a process is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Health {
    /// It is at work.
    Running,
    /// It has ended by itself.
    Ended,
    /// It has not been heard of for a minute, or is known to be gone: it was killed, or its machine is down.
    Silent,
}

impl Runner {
    /// Its shard; all trials where the file says what is none.
    #[must_use]
    pub fn shard(&self) -> Shard {
        let [number, of] = self.shard;
        Shard::new(number, of).unwrap_or(Shard::WHOLE)
    }

    /// How it is, at a time in seconds since 1970.
    #[must_use]
    pub fn health(&self, now_s: f64) -> Health {
        let is_gone = || {
            self.host == host()
                && Path::new("/proc/self").exists()
                && !Path::new("/proc").join(self.process.to_string()).exists()
        };
        if self.ended {
            Health::Ended
        } else if now_s - self.heard_s > SILENT_S || is_gone() {
            Health::Silent
        } else {
            Health::Running
        }
    }

    /// The processes that say something in the folder `dir`, the latest of each shard, in order of shards. What cannot be read is left out.
    #[must_use]
    pub fn all(dir: &Path) -> Vec<Self> {
        let names = fs::read_dir(dir)
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path());
        let files = names.filter(|path| path.to_string_lossy().ends_with(ENDING));
        let read = |path: PathBuf| serde_json::from_slice::<Self>(&fs::read(path).ok()?).ok();
        let mut all: Vec<Self> = files.filter_map(read).collect();
        Self::latest(&mut all);
        all
    }

    /// Keeps the latest of each shard, in order of shards.
    pub(super) fn latest(all: &mut Vec<Self>) {
        all.sort_by(|a, b| a.shard().cmp(&b.shard()).then(b.began_s.total_cmp(&a.began_s)));
        all.dedup_by_key(|runner| runner.shard());
    }
}

/// Seconds since 1970.
#[must_use]
pub fn now_s() -> f64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0.0, |since| since.as_secs_f64())
}

fn host() -> String {
    let named = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let named = named.or_else(|| std::env::var("HOSTNAME").ok());
    named.map_or_else(|| "unknown".to_owned(), |name| name.trim().to_owned())
}

/// Says how far this process is, until it is dropped.
pub(super) struct Telling {
    state: Arc<Mutex<Runner>>,
    /// Dropped to end the thread that writes.
    end: Option<mpsc::Sender<()>>,
    writer: Option<JoinHandle<()>>,
}

impl Telling {
    /// Begins in the folder `dir`, which is there. Where nothing can be written there, nothing is said.
    pub fn begin(dir: &Path, shard: Shard, jobs: usize, left: u32) -> Self {
        let now = now_s();
        let runner = Runner {
            shard: [shard.number(), shard.of()],
            host: host(),
            process: std::process::id(),
            jobs,
            began_s: now,
            heard_s: now,
            finished: 0,
            wall_s: 0.0,
            left,
            under_way: Vec::new(),
            failed: None,
            ended: false,
        };
        let path = dir.join(file_name(&runner));
        let state = Arc::new(Mutex::new(runner));
        let (end, ended) = mpsc::channel();
        let shared = Arc::clone(&state);
        let dir = dir.to_owned();
        let writer = thread::spawn(move || keep_telling(&dir, &path, &shared, &ended));
        Self {
            state,
            end: Some(end),
            writer: Some(writer),
        }
    }

    /// A trial begins.
    pub fn starts(&self, setting: usize, trial: u32) {
        self.state().under_way.push(UnderWay {
            setting,
            trial,
            began_s: now_s(),
        });
    }

    /// A trial is over; it failed for a `reason`, unless there is none.
    pub fn stops(&self, setting: usize, trial: u32, reason: Option<String>) {
        let mut state = self.state();
        if let Some(place) = state
            .under_way
            .iter()
            .position(|own| (own.setting, own.trial) == (setting, trial))
        {
            let ran = state.under_way.remove(place);
            if reason.is_none() {
                state.finished += 1;
                state.left = state.left.saturating_sub(1);
                state.wall_s += now_s() - ran.began_s;
            }
        }
        if let (Some(reason), None) = (reason, &state.failed) {
            state.failed = Some(FailedTrial { setting, trial, reason });
        }
    }

    fn state(&self) -> MutexGuard<'_, Runner> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Telling {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(writer) = self.writer.take() {
            let _ = writer.join();
        }
    }
}

fn file_name(runner: &Runner) -> String {
    let [number, of] = runner.shard;
    let host: String = runner
        .host
        .chars()
        .filter(|letter| letter.is_ascii_alphanumeric() || *letter == '-')
        .collect();
    format!("{number}-of-{of}.{host}.{}{ENDING}", runner.process)
}

/// Writes what is new once a second, and every ten seconds that there is nothing, until the other end is dropped.
fn keep_telling(dir: &Path, path: &Path, state: &Mutex<Runner>, ended: &mpsc::Receiver<()>) {
    let mut said: Option<Runner> = None;
    let mut turns = 0;
    loop {
        let mut now = state.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let is_news = said.as_ref() != Some(&now);
        said = Some(now.clone());
        turns += 1;
        if is_news || turns >= SIGN_OF_LIFE {
            tell(dir, path, &mut now);
            turns = 0;
        }
        if ended.recv_timeout(NEWS) != Err(RecvTimeoutError::Timeout) {
            let mut last = state.lock().unwrap_or_else(PoisonError::into_inner).clone();
            last.ended = true;
            tell(dir, path, &mut last);
            return;
        }
    }
}

fn tell(dir: &Path, path: &Path, runner: &mut Runner) {
    use std::io::Write;
    runner.heard_s = now_s();
    let text = serde_json::to_vec(runner).unwrap_or_default();
    if let Err(error) = replace(dir, path, |mut file| file.write_all(&text)) {
        tracing::debug!(path = %path.display(), %error, "cannot say how far the trials are");
    }
}
