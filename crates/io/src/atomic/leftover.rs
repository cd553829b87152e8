//! Temporary files that a killed process could not remove.

use std::path::Path;

/// How each temporary name begins. Only Linux states which process wrote a file.
const NAME: &str = ".ridgelight-";

/// The beginning of this process's temporary names.
pub(super) fn prefix() -> String {
    #[cfg(target_os = "linux")]
    if let Some(system) = linux::system() {
        return format!("{NAME}{system}-{}-", std::process::id());
    }
    NAME.to_owned()
}

/// Removes the temporary files of processes that have ended. A file that cannot be removed stays: it is in nobody's way.
pub(super) fn remove_from(folder: &Path) {
    #[cfg(target_os = "linux")]
    linux::remove_from(folder);
    #[cfg(not(target_os = "linux"))]
    let _ = folder;
}

#[cfg(target_os = "linux")]
mod linux {
    use super::NAME;
    use rustix::process::{Pid, test_kill_process};
    use std::hash::{DefaultHasher, Hash, Hasher};
    use std::path::Path;

    /// Where a process number means the same process: one start of one machine, and one container. Others may write to the
    /// same folder.
    pub fn system() -> Option<String> {
        let start = std::fs::read("/proc/sys/kernel/random/boot_id").ok()?;
        let container = std::fs::read_link("/proc/self/ns/pid").ok()?;
        let mut hasher = DefaultHasher::new();
        (start, container).hash(&mut hasher);
        Some(format!("{:016x}", hasher.finish()))
    }

    pub fn remove_from(folder: &Path) {
        let (Some(system), Ok(entries)) = (system(), folder.read_dir()) else { return };
        let start = format!("{NAME}{system}-");
        for entry in entries.flatten() {
            let name = entry.file_name();
            let writer =
                name.to_str().and_then(|name| name.strip_prefix(&start)?.split('-').next());
            let writer = writer.and_then(|id| Pid::from_raw(id.parse().ok()?));
            let has_ended = |id| test_kill_process(id) == Err(rustix::io::Errno::SRCH);
            if writer.is_some_and(has_ended) {
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use crate::write_text;
    use std::collections::BTreeSet;

    #[test]
    fn files_of_ended_processes_go_and_others_stay() {
        let folder = tempfile::tempdir().unwrap();
        let system = super::linux::system().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        let [ended, parent] = [child.id(), std::os::unix::process::parent_id()];
        let stays = [
            format!(".ridgelight-{system}-{parent}-abc"),
            format!(".ridgelight-0123456789abcdef-{ended}-abc"),
            format!(".ridgelight-{system}-0-abc"),
            format!(".ridgelight-{system}-x-abc"),
            ".ridgelight-abc".to_owned(),
            format!("ridgelight-{system}-{ended}-abc"),
        ];
        let goes = format!(".ridgelight-{system}-{ended}-abc");
        for name in stays.iter().chain([&goes]) {
            std::fs::write(folder.path().join(name), "x").unwrap();
        }
        write_text(&folder.path().join("out.txt"), "done").unwrap();
        let left: BTreeSet<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        assert_eq!(left, stays.into_iter().chain(["out.txt".to_owned()]).collect());
    }
}
