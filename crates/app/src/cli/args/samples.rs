//! A range of a picture's samples, and all of them as a list of jobs: one line of `visavis render` for each range, for
//! other machines to run.

use super::options::CommandOption;
use super::render::{Reading, TRACED};
use super::usage;
use super::values::text;
use crate::cli::{CliError, Command, RenderArgs};
use image_file::Kind;
use std::ffi::OsString;
use std::path::Path;
use technique::{SampleRanges, Technique, quoted};

/// Lines of a list at most.
const MOST_JOBS: u32 = 65_536;

pub fn options() -> [CommandOption<Reading>; 2] {
    [
        CommandOption {
            names: &["--samples"],
            value: "FROM..TO",
            help: "in place of --spp: of the samples that --spp TO takes of a pixel those from number FROM on, the first being 0, with \
                   their sums, from which visavis merge makes one picture of several ranges; EXR only",
            read: |reading, parser| {
                let word = text(parser)?;
                reading.args.samples = match word.parse() {
                    Ok(samples) => Some(samples),
                    Err(expected) => return usage(format!("--samples {word}: expected {expected}")),
                };
                reading.given.push(("--samples".into(), TRACED));
                Ok(())
            },
        },
        CommandOption {
            names: &["--jobs"],
            value: "N",
            help: "render nothing, but print N lines with a range of the samples each, for as many machines or jobs: of OUT.exr they \
                   make OUT.1-of-N.exr and so on, for visavis merge (docs/many-machines.md)",
            read: |reading, parser| {
                let word = text(parser)?;
                let jobs = word.parse().ok().filter(|jobs| (1..=MOST_JOBS).contains(jobs));
                let Some(jobs) = jobs else {
                    return usage(format!("--jobs {word}: expected a whole number from 1 to {MOST_JOBS}"));
                };
                reading.args.jobs = Some(jobs);
                reading.given.push(("--jobs".into(), TRACED));
                Ok(())
            },
        },
    ]
}

/// Refuses a range that cannot be had. Where a list of jobs is asked for it takes the command's place.
pub fn checked(command: Command, typed: &[OsString]) -> Result<Command, CliError> {
    let Command::Render(args) = &command else { return Ok(command) };
    let option = if args.jobs.is_some() { "--jobs" } else { "--samples" };
    let Some(samples) = args.samples.clone().or(args.jobs.map(|_| (0..args.spp_wanted()).into())) else {
        return Ok(command);
    };
    if is_typed(typed, "--samples") && is_typed(typed, "--spp") {
        return usage("--samples and --spp both say how many samples: leave one out");
    }
    if let Some(why) = why_not(args) {
        return usage(format!("{option}: {why}"));
    }
    if samples.without_gaps().is_none() {
        return usage(format!("--samples {samples}: one film has no gap; render each range by itself and merge them"));
    }
    let lines = args.jobs.and_then(|jobs| Some(lines(typed, &samples.split(jobs)?, &args.out)));
    Ok(lines.map_or(command, Command::Print))
}

/// Why there is no film of a range of such a picture's samples.
fn why_not(args: &RenderArgs) -> Option<String> {
    let traced = match args.pane.in_use() {
        Technique::Traced(traced) => traced,
        Technique::Fake(_) => return Some("the fake has no samples".into()),
    };
    if let Some(feature) = traced.feature {
        return Some(format!("--show {} is no sum of samples", feature.name()));
    }
    if args.pane.in_use().runs() > 1 {
        return Some("a range is one of one picture's samples, and --runs asks for several: leave it out".into());
    }
    if traced.denoise.is_on() {
        return Some("denoise what is merged of all ranges, not each of them: leave --denoise out".into());
    }
    let is_exr = Kind::of(&args.out) == Some(Kind::Exr);
    (!is_exr).then(|| format!("sums of samples need -o OUT.exr: {}", image_file::shown(&args.out)))
}

/// Whether an option of this name is among the words.
pub fn is_typed(words: &[OsString], name: &str) -> bool {
    words.iter().any(|word| word.to_string_lossy().split('=').next() == Some(name))
}

/// Without what says how many samples, where something else was typed that says so.
pub fn without_other_samples(made: Vec<OsString>, typed: &[OsString]) -> Vec<OsString> {
    let says_so = ["--spp", "--samples"];
    if !says_so.iter().any(|name| is_typed(typed, name)) {
        return made;
    }
    let is_other = |word: &OsString| says_so.iter().any(|name| is_typed(std::slice::from_ref(word), name));
    made.into_iter().filter(|word| !is_other(word)).collect()
}

/// Options with a value that every job has its own of, or none.
const OF_THE_WHOLE: [&str; 4] = ["--jobs", "--samples", "--spp", "-o"];

/// The lines, each with a range of the samples, of what was typed after `render`. Their files are numbered: of `a.exr` they are
/// `a.1-of-16.exr` and so on.
fn lines(typed: &[OsString], samples: &[SampleRanges], out: &Path) -> String {
    let common = common(typed);
    let line = |(index, range): (usize, &SampleRanges)| {
        let number = format!("{:0width$}", index + 1, width = samples.len().to_string().len());
        let file = out.with_extension(format!("{number}-of-{}.exr", samples.len()));
        format!("visavis render{common} --samples {range} -o {}\n", quoted(&file.to_string_lossy()))
    };
    samples.iter().enumerate().map(line).collect()
}

/// The words that all jobs have in common, a blank before each.
fn common(typed: &[OsString]) -> String {
    let mut text = String::new();
    let mut words = typed.iter().map(|word| word.to_string_lossy());
    while let Some(word) = words.next() {
        let is_out = word.starts_with("-o");
        if OF_THE_WHOLE.contains(&&*word) {
            words.next();
        } else if !is_out && !OF_THE_WHOLE.contains(&word.split('=').next().unwrap_or_default()) {
            text += &format!(" {}", quoted(&word));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_job_has_its_range_and_file_and_all_else_in_common() {
        let typed = "it's/a.toml --spp 9 -o b.exr --jobs=2 --seed 7 --samples=0..9 -ob.exr --estimator=mis".split(' ');
        let typed: Vec<OsString> = typed.map(Into::into).collect();
        let samples: SampleRanges = "0..9".parse().unwrap();
        let lines = lines(&typed, &samples.split(2).unwrap(), Path::new("out dir/b.exr"));
        let expected = [("0..4", 1), ("4..9", 2)].map(|(range, number)| {
            format!(
                r"visavis render 'it'\''s/a.toml' --seed 7 --estimator=mis --samples {range} -o 'out dir/b.{number}-of-2.exr'"
            ) + "\n"
        });
        assert_eq!(lines, expected.concat());
    }

    #[test]
    fn numbers_sort_as_words() {
        let samples: SampleRanges = "0..12".parse().unwrap();
        let lines = lines(&["cornell".into()], &samples.split(12).unwrap(), Path::new("a.exr"));
        let files: Vec<&str> = lines.lines().filter_map(|line| line.split(' ').next_back()).collect();
        assert_eq!((files[0], files[11]), ("a.01-of-12.exr", "a.12-of-12.exr"));
        assert!(files.is_sorted());
    }
}
