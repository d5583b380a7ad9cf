//! `desim new`: a scenario to begin with, a crate with a protocol of one's own, or a script that runs trials on a cluster.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::RangedU64ValueParser;

use super::failure::Failure;
use crate::experiment::Shard;
use crate::scenario::{contents, is_study, load, load_study};
use crate::text::shown;

/// What `desim new --help` says.
pub const LONG_ABOUT: &str = "\
Writes a commented scenario, NAME.ron, to begin with. With --protocol it writes a crate instead, the folder NAME: a protocol of your own \
with its settings, its figures and its test, a scenario, a study, and a `main` that is the whole command. Both run as they stand.

With --slurm N it writes a script, NAME.slurm.sh, which runs a scenario or a study as an array of N tasks of Slurm and puts their trials together.

NAME becomes the name of the scenario, or of the crate and of its protocol: small letters, digits and `_`. What is there already is never written over.";

/// Arguments of `desim new`.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// Name of the scenario, the crate or the script, such as `my_flood`
    #[arg(value_name = "NAME", value_parser = name)]
    pub name: String,
    /// Write a crate with a protocol of your own
    #[arg(long)]
    pub protocol: bool,
    /// Write a script that runs trials as an array of N tasks of Slurm
    #[arg(long, value_name = "N", conflicts_with = "protocol", value_parser = RangedU64ValueParser::<u32>::new().range(1..=u64::from(Shard::MOST)))]
    pub slurm: Option<u32>,
    /// The scenario or the study that the script runs [default: NAME.ron]
    #[arg(long, value_name = "FILE", requires = "slurm")]
    pub run: Option<PathBuf>,
    /// Folder of desim's sources for the crate to build with [default: those that this command was built from, if they are there; else
    /// the published crate]
    #[arg(long, value_name = "DIR", requires = "protocol")]
    pub desim: Option<PathBuf>,
}

/// A file of a template: where it goes, and its text.
type File = (&'static str, &'static str);

const SLURM: &str = include_str!("../../examples/new/slurm.sh");
const SCENARIO: &str = include_str!("../../examples/new/scenario.ron");

/// The crate. Its manifest is kept under another name, so that it is no crate within this one.
const CRATE: [File; 7] = [
    ("Cargo.toml", include_str!("../../examples/new/protocol/Cargo.toml.txt")),
    (".gitignore", "/target\n/results\n"),
    ("README.md", include_str!("../../examples/new/protocol/README.md")),
    ("src/main.rs", include_str!("../../examples/new/protocol/src/main.rs")),
    (
        "src/protocol.rs",
        include_str!("../../examples/new/protocol/src/protocol.rs"),
    ),
    (
        "scenarios/my_protocol.ron",
        include_str!("../../examples/new/protocol/scenarios/my_protocol.ron"),
    ),
    (
        "scenarios/loss.ron",
        include_str!("../../examples/new/protocol/scenarios/loss.ron"),
    ),
];

/// What the crate depends on where desim's sources are not there.
const PUBLISHED: &str = concat!(
    "desim = { package = \"desim-swarm\", version = \"",
    env!("CARGO_PKG_VERSION"),
    "\" }"
);

fn name(text: &str) -> Result<String, String> {
    let fits = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    let begins = text.starts_with(|letter: char| letter.is_ascii_lowercase());
    if begins && text.len() <= 64 && text.chars().all(fits) {
        Ok(text.to_owned())
    } else {
        Err("use 1 to 64 small letters, digits and `_`, a letter first".to_owned())
    }
}

/// Runs the command, and says on `out` what to do next.
///
/// # Errors
/// If something of that name is there, desim's sources are not where they are said to be, or a file cannot be written.
pub fn run(arguments: &NewArguments, out: &mut dyn Write) -> Result<(), Failure> {
    let name = &arguments.name;
    if let Some(shards) = arguments.slurm {
        return slurm(arguments, shards, out);
    }
    if !arguments.protocol {
        let path = PathBuf::from(format!("{name}.ron"));
        write(&path, &SCENARIO.replace("my_scenario", name))?;
        let path = shown(&path);
        writeln!(out, "{path}: run it by `desim scenario {path}`")?;
        return Ok(());
    }
    let folder = Path::new(name);
    let dependency = dependency(arguments.desim.as_deref())?;
    fs::create_dir(folder).map_err(|error| refused(folder, &error))?;
    let protocol = camel(name);
    for (file, text) in CRATE {
        let text = text
            .replace(PUBLISHED, &dependency)
            .replace("my_protocol", name)
            .replace("MyProtocol", &protocol);
        let path = folder.join(file.replace("my_protocol", name));
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| refused(parent, &error))?;
        }
        write(&path, &text)?;
    }
    let folder = shown(folder);
    writeln!(
        out,
        "{folder}: a crate with the protocol {protocol}\n  cd {folder}\n  cargo test\n  cargo run --release -- scenario scenarios/{name}.ron"
    )?;
    Ok(())
}

/// Writes the script, which runs a file that is well.
fn slurm(arguments: &NewArguments, shards: u32, out: &mut dyn Write) -> Result<(), Failure> {
    let name = &arguments.name;
    let file = arguments.run.clone().unwrap_or_else(|| format!("{name}.ron").into());
    let command = if is_study(&contents(&file)?) {
        load_study(&file)?;
        "compare"
    } else {
        load(&file, &[])?;
        "scenario"
    };
    let written = file.to_str().filter(|file| file.chars().all(stands_for_itself));
    let written = written.ok_or_else(|| {
        Failure::Input(format!(
            "error: {}: a shell would read this name as something else; call the file otherwise",
            shown(&file)
        ))
    })?;
    let text = SLURM
        .replace("my_file", written)
        .replace("my_name", name)
        .replace("my_shards", &shards.to_string())
        .replace("my_command", command);
    let path = PathBuf::from(format!("{name}.slurm.sh"));
    write(&path, &text)?;
    let path = shown(&path);
    writeln!(out, "{path}: run it by `bash {path}`")?;
    Ok(())
}

/// Whether a letter within quotes means itself to a shell.
fn stands_for_itself(letter: char) -> bool {
    !letter.is_control() && !['"', '$', '`', '\\', '!'].contains(&letter)
}

/// How the crate is to depend on desim.
fn dependency(asked: Option<&Path>) -> Result<String, Failure> {
    let by_path = |folder: &Path| {
        let folder = folder.canonicalize().ok()?;
        folder.join("src/lib.rs").is_file().then_some(())?;
        let folder = folder.to_str()?.replace('\\', "\\\\").replace('"', "\\\"");
        Some(format!("desim = {{ package = \"desim-swarm\", path = \"{folder}\" }}"))
    };
    match asked {
        Some(folder) => by_path(folder).ok_or_else(|| {
            Failure::Input(format!(
                "error: --desim {}: desim's sources are not there",
                shown(folder)
            ))
        }),
        None => Ok(by_path(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap_or_else(|| PUBLISHED.to_owned())),
    }
}

/// `my_flood` as a type is written: `MyFlood`.
fn camel(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    words.map(capital).collect()
}

/// Writes a file that is not there yet.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    let mut file = file.map_err(|error| refused(path, &error))?;
    file.write_all(text.as_bytes()).map_err(|error| refused(path, &error))
}

fn refused(path: &Path, error: &io::Error) -> Failure {
    let path = shown(path);
    if error.kind() == io::ErrorKind::AlreadyExists {
        Failure::Input(format!("error: {path} is there already; choose another name"))
    } else {
        Failure::Other(format!("error: cannot write {path}: {error}"))
    }
}
