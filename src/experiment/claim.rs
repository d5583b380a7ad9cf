//! The claim of one process to the trials in a folder.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use super::parts::{PartsError, failed};

/// The claim of this process to the trials in a folder, until it is dropped: to run them all, and to put them together. A second process that
/// claims them is refused, so that nobody waits for what another is about to finish.
///
/// Nothing depends on it but that. Files are whole whoever writes them, and a trial that two processes have run is the same twice. So shards
/// claim nothing, and where a file system knows no locks there is no claim.
#[derive(Debug)]
pub struct Claim {
    _lock: Option<File>,
}

impl Claim {
    /// Claims the folder `dir`, made if need be.
    ///
    /// # Errors
    /// If another process has claimed it, or it cannot be made or written.
    pub fn lay(dir: &Path) -> Result<Self, PartsError> {
        fs::create_dir_all(dir).map_err(failed("create the folder", dir))?;
        let path = dir.join("lock");
        let lock = File::create(&path).map_err(failed("create", &path))?;
        match lock.try_lock() {
            Ok(()) => Ok(Self { _lock: Some(lock) }),
            Err(fs::TryLockError::WouldBlock) => Err(PartsError::Busy(dir.to_owned())),
            Err(fs::TryLockError::Error(error)) if knows_no_locks(&error) => {
                tracing::debug!(path = %path.display(), %error, "cannot be locked");
                Ok(Self { _lock: None })
            }
            Err(fs::TryLockError::Error(source)) => Err(failed("lock", &path)(source)),
        }
    }
}

/// Whether a file system says by this that it has no locks, as those of clusters may.
fn knows_no_locks(error: &io::Error) -> bool {
    /// No locks available: what NFS answers where its lock service does not run.
    const ENOLCK: i32 = 37;
    error.kind() == io::ErrorKind::Unsupported || error.raw_os_error() == Some(ENOLCK)
}
