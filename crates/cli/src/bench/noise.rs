//! Warnings of a machine on which times are not to be trusted.

use std::time::Duration;

use super::rows::Row;

/// A frame whose median is known no better says that the machine is too noisy for a published table.
const NOISY: f64 = 0.1;

/// A warning if the median of a frame is too uncertain: reports the worst and the number of others.
pub fn noise(rows: &[Row]) -> Option<String> {
    let totals = || rows.iter().filter(|row| row.pass == "total");
    let noisy = totals().filter(|row| row.spread() > Some(NOISY)).count();
    let worst =
        totals().max_by(|a, b| a.spread().unwrap_or(0.0).total_cmp(&b.spread().unwrap_or(0.0)))?;
    let [cols, rows] = worst.size;
    let others = match noisy {
        0 => return None,
        1 => String::new(),
        count => format!("; {count} of {} totals exceed 10 %", totals().count()),
    };
    Some(format!(
        "noisy: the 95 % confidence interval of the {} total of {cols}x{rows}, {} azimuths, spans {:.0} % of its median, expected at most \
         10 %{others}",
        worst.mode.replace('_', " "),
        worst.azimuths,
        100.0 * worst.spread()?
    ))
}

/// A warning if other programs keep half of the cores or more busy: the median of a few counts of threads that run. Steady load
/// widens no confidence interval. None where the system does not state it.
pub fn busy() -> Option<String> {
    const COUNTS: usize = 9;
    const INTERVAL: Duration = Duration::from_millis(15);
    let mut running = Vec::new();
    for _ in 0..COUNTS {
        std::thread::sleep(INTERVAL);
        running.push(others_running(&std::fs::read_to_string("/proc/loadavg").ok()?)?);
    }
    running.sort_unstable();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let others = running[COUNTS / 2];
    (2 * others >= cores.max(2)).then(|| {
        format!(
            "busy: other programs run {others} threads on {cores} cores, so times may be too long"
        )
    })
}

/// Threads that run beside this one: the fourth entry of /proc/loadavg is "running/all".
fn others_running(loadavg: &str) -> Option<usize> {
    let (running, _) = loadavg.split_whitespace().nth(3)?.split_once('/')?;
    running.parse::<usize>().ok()?.checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::super::rows;
    use super::*;

    #[test]
    fn running_threads_are_counted_without_this_one() {
        assert_eq!(others_running("0.20 0.18 0.12 1/80 11206\n"), Some(0));
        assert_eq!(others_running("4.20 3.18 2.12 5/412 9\n"), Some(4));
        assert_eq!([others_running(""), others_running("1 2 3 4 5")], [None; 2]);
    }

    #[test]
    fn a_frame_of_a_noisy_machine_is_named() {
        let plan = rows::tests::plan();
        // 10 values about 100, whose interval goes from the 2nd to the 9th: `step` apart, it is 7 steps wide.
        let row = |pass, step: f64| {
            let times: Vec<f64> = (0..10).map(|i| 100.0 + step * f64::from(i)).collect();
            Row::of(pass, "in_flow", &plan, &[], 4, (10, &times))
        };
        assert_eq!(noise(&[row("total", 1.5), row("sky_shade", 9.0)]), None);
        let said = noise(&[row("total", 2.0)]).unwrap();
        assert!(said.contains("in flow total of ") && said.contains(" spans 13 %"), "{said}");
        assert!(!said.contains("totals"), "{said}");
        // The worst of several, and their number.
        let said = noise(&[row("total", 2.0), row("total", 1.5), row("total", 3.0)]).unwrap();
        assert!(
            said.contains(" spans 19 %") && said.ends_with("; 2 of 3 totals exceed 10 %"),
            "{said}"
        );
        // Too few runs for an interval say nothing.
        assert_eq!(
            noise(&[Row::of("total", "in_flow", &plan, &[], 4, (3, &[1.0, 2.0, 9.0]))]),
            None
        );
    }
}
