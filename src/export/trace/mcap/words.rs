//! Events of a recording in words.

use foxglove::messages::Log;
use foxglove::messages::log::Level;

use super::super::context::Run;
use super::message::timestamp;
use crate::happenings::log::{Event, What};

/// An event, unless it is one of those that say how a protocol works inside, which tables have.
pub fn log(run: &Run, event: &Event) -> Option<Log> {
    let name = match event.robot {
        Some(robot) => format!("robot {}", robot.0),
        None => "links".to_owned(),
    };
    Some(Log {
        timestamp: Some(timestamp(event.at)),
        level: level(&event.what).into(),
        message: words(run, &event.what)?,
        name,
        file: String::new(),
        line: 0,
    })
}

fn level(what: &What) -> Level {
    match what {
        What::Fails(_) | What::LinksFail(_) => Level::Error,
        What::Suspects(..) => Level::Warning,
        _ => Level::Info,
    }
}

fn words(run: &Run, what: &What) -> Option<String> {
    Some(match what {
        What::Fails(effect) => format!("fails: {}", effect.name()),
        What::Recovers(effect) => format!("recovers: {}", effect.name()),
        What::LinksFail(kind) => format!("fail: {kind}"),
        What::LinksRecover(kind) => format!("recover: {kind}"),
        What::Suspects(robot, heard) => {
            format!("suspects robot {}, last heard at {} s", robot.0, heard.as_secs())
        }
        What::Trusts(robot) => format!("trusts robot {} again", robot.0),
        What::Enters(role) => format!("is {} now", run.role(*role)),
        What::Serves(Some(target)) => format!("works for target {target}"),
        What::Serves(None) => "works for no target".to_owned(),
        What::Learns(rumor, Some(from)) => format!("learns rumour {rumor} from robot {}", from.0),
        What::Learns(rumor, None) => format!("begins rumour {rumor}"),
        What::Watches(_) | What::ReliesOn(_) | What::Counts(..) | What::Measures(..) => return None,
    })
}
