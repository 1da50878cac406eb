//! The bench: it writes what it promises, goes on after it was killed, and says in one line what stands in its way.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use visavis_tests::TestFolder;

/// A bench of a few seconds; all that it depends on is in `folder`.
fn bench(folder: &TestFolder, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_visavis"));
    command.args(["bench", "--time", "4", "--scene", "cornell", "-o"]).arg(folder.file("results")).args(arguments);
    command.env("VISAVIS_CACHE", folder.file("references")).env("XDG_RUNTIME_DIR", std::env::temp_dir());
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Lines of the journal after its first: finished measurements.
fn measured(folder: &TestFolder) -> usize {
    let journal = std::fs::read(folder.file("results/journal.jsonl")).unwrap_or_default();
    journal.iter().filter(|byte| **byte == b'\n').count().saturating_sub(1)
}

#[test]
fn killed_anywhere_it_goes_on_with_what_it_has() {
    let folder = TestFolder::new();
    let mut kills = 0;
    // after ever more measurements, and in the midst of one
    for least in [1, 7, 20] {
        let mut child = bench(&folder, &[]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program");
        let start = Instant::now();
        while measured(&folder) < least && start.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(5));
        }
        // SIGKILL, to this child alone
        child.kill().expect("it runs or has ended");
        kills += usize::from(!child.wait().expect("its end").success());
    }
    let before = measured(&folder);
    assert!(kills >= 2 && before >= 20, "{kills} {before}");
    let journal = folder.file("results/journal.jsonl");
    let kept: Vec<String> = read(&journal).split_inclusive('\n').take(before + 1).map(str::to_owned).collect();
    std::fs::write(&journal, kept.concat() + "{\"part\":\"cornell\",\"li").expect("a line that was cut");

    let output = bench(&folder, &[]).output().expect("the program");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains(&format!("{before} of ")), "{}", stderr(&output));
    assert_eq!(stderr(&output).lines().count(), 1, "more than one line, and no terminal: {}", stderr(&output));
    assert!(read(&journal).starts_with(&kept.concat()), "what was measured is measured again");
    let rows = read(&folder.file("results/measurements.csv"));
    let mut keys: Vec<String> =
        rows.lines().skip(1).map(|row| row.split(',').take(8).collect::<Vec<_>>().join(",")).collect();
    keys.retain(|key| !key.contains("raster"));
    let all = keys.len();
    keys.sort();
    keys.dedup();
    assert!(keys.len() == all && all >= 5 * 12, "{all} rows, {} of them different", keys.len());

    // nothing is left to do but the page, now with a peer; other options are another bench
    let peer = folder.file("peer.csv");
    std::fs::write(&peer, "name,scene,spp,seconds,relmse\n<b>Peer & co</b>,cornell,16,0.5,0.01\n").expect("a table");
    let output = bench(&folder, &["--peer", peer.to_str().unwrap()]).output().expect("the program");
    assert!(output.status.success(), "{}", stderr(&output));
    let page = read(&folder.file("results/bench.html"));
    assert!(page.contains("&lt;b&gt;Peer &amp; co&lt;/b&gt;") && !page.contains("<b>Peer"));
    assert_self_contained(&page);
    assert_rows_are_as_wide_as_the_header(&read(&folder.file("results/summary.csv")));
    assert_rows_are_as_wide_as_the_header(&rows);
    let other = bench(&folder, &["--time", "5"]).output().expect("the program");
    assert_eq!((other.status.code(), stderr(&other).lines().count()), (Some(1), 1));
    assert!(stderr(&other).contains("4 s, this is 5 s") && stderr(&other).contains("journal.jsonl"));
}

fn assert_self_contained(page: &str) {
    for outside in ["<script", "<link", "src=\"http", "href=", "url(", "@import"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.matches("<svg").count() == 3 && page.matches("data:image/png;base64,").count() >= 4);
    assert!(page.contains("0 bounces") && page.contains("How this page was made"));
}

fn assert_rows_are_as_wide_as_the_header(csv: &str) {
    let mut widths = csv.lines().map(|row| row.split(',').count());
    let header = widths.next().expect("a header");
    assert!(widths.all(|width| width == header), "{csv}");
}

#[test]
fn without_a_gpu_the_fakes_are_left_out_and_it_is_said() {
    let folder = TestFolder::new();
    // an interface that this system does not have
    let output = bench(&folder, &["--time", "1"]).env("WGPU_BACKEND", "dx12").output().expect("the program");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("The fakes are left out: no graphics adapter was found"), "{}", stderr(&output));
    let page = read(&folder.file("results/bench.html"));
    assert!(page.contains("The fakes are left out") && !page.contains("fake, fair"));
}

#[test]
fn what_stands_in_its_way_is_said_in_one_line() {
    let folder = TestFolder::new();
    let refused = |command: &mut Command, words: &[&str]| {
        let output = command.output().expect("the program");
        let line = stderr(&output);
        assert_eq!((output.status.code(), line.lines().count()), (Some(1), 1), "{line}");
        words.iter().for_each(|word| assert!(line.contains(word), "'{word}' is not in: {line}"));
    };
    let program = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_visavis"));
        command.arg("bench").arg("--quick");
        command
    };
    let file = folder.file("file");
    std::fs::write(&file, "").expect("a file");
    refused(program().arg("-o").arg(&file), &["cannot make the folder", "file"]);
    if cfg!(target_os = "linux") {
        // nobody may write here, not even root
        refused(program().args(["-o", "/proc/visavis"]), &["cannot make the folder", "/proc/visavis"]);
    }
    let bad = folder.file("bad.csv");
    std::fs::write(&bad, "name,scene,spp,seconds,relmse\nx,cornell,1,1,oops\n").expect("a table");
    let words = ["line 2", "'oops'", "a number above 0", "bad.csv"];
    refused(program().arg("-o").arg(folder.file("new")).arg("--peer").arg(&bad), &words);
    assert!(!folder.file("new").exists());
}

/// A disk that is full is a file that may grow no further: the system refuses the write in the same place.
#[cfg(unix)]
#[test]
fn on_a_full_disk_it_stops_with_one_line_and_keeps_what_it_has() {
    let folder = TestFolder::new();
    let program = bench(&folder, &["--time", "1"]);
    let words: Vec<_> = program.get_args().map(|word| format!("'{}'", word.to_str().unwrap())).collect();
    // 24 blocks of 512 or 1024 bytes; the signal that would come instead of an error is ignored
    let script = format!("trap '' XFSZ; ulimit -f 24; exec '{}' {}", env!("CARGO_BIN_EXE_visavis"), words.join(" "));
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).env("XDG_RUNTIME_DIR", std::env::temp_dir());
    shell.env("VISAVIS_CACHE", folder.file("references")).env_remove("DISPLAY");
    let mut child = shell.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("sh");
    let mut line = String::new();
    child.stderr.take().expect("its stderr").read_to_string(&mut line).expect("words");
    assert_eq!((child.wait().expect("its end").code(), line.lines().count()), (Some(1), 1), "{line}");
    assert!(line.contains("cannot write the journal") && line.contains("journal.jsonl"), "{line}");
    let kept = measured(&folder);
    assert!(kept >= 2, "{kept}");
    let output = bench(&folder, &["--time", "1"]).output().expect("the program");
    assert!(output.status.success() && stderr(&output).contains(&format!("{kept} of ")), "{}", stderr(&output));
}
