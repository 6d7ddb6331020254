//! The chat-completions client against a server that also answers with errors, delays and nonsense.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use lamma_lm::cassette::{Record, Replay};
use lamma_lm::http::Http;
use lamma_lm::{
    Answer, ChatModel, Fallback, LanguageModel, LmError, ObjectView, Offline, Options, Request, RobotView,
    from_spec,
};
use serde_json::{Value, json};

/// What the server does with the n-th request.
type Script = Box<dyn Fn(usize, &Value) -> Act + Send>;

enum Act {
    Answer(u16, Vec<(&'static str, String)>, Vec<u8>),
    Truncate,
    Hang(Duration),
    Close,
}

struct Server {
    url: String,
    seen: Arc<Mutex<Vec<(String, Value)>>>,
}

impl Server {
    fn start(script: Script) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let url = format!("http://{}/v1", listener.local_addr().expect("it is bound"));
        let seen: Arc<Mutex<Vec<(String, Value)>>> = Arc::default();
        let log = Arc::clone(&seen);
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                let Ok(mut stream) = stream else { return };
                let Some((head, body)) = read_request(&mut stream) else { continue };
                let n = {
                    let mut log = log.lock().expect("no test panics while it holds the log");
                    log.push((head, body.clone()));
                    log.len()
                };
                act(&mut stream, script(n, &body));
            }
        });
        Self { url, seen }
    }

    fn requests(&self) -> Vec<(String, Value)> {
        self.seen.lock().expect("no test panics while it holds the log").clone()
    }

    fn http(&self, retries: u32) -> Http {
        Http::new(&self.url, Some("secret".to_owned()), retries, 1)
            .with_pauses(Duration::from_millis(1), Duration::from_millis(4))
    }

    fn model(&self, retries: u32) -> ChatModel<Http> {
        ChatModel::new(self.http(retries), "tiny".to_owned(), 2, 1)
    }
}

fn read_request(stream: &mut TcpStream) -> Option<(String, Value)> {
    let mut bytes = Vec::new();
    let mut buffer = [0; 4096];
    let (head, rest) = loop {
        let n = stream.read(&mut buffer).ok().filter(|n| *n > 0)?;
        bytes.extend_from_slice(&buffer[..n]);
        if let Some(at) = bytes.windows(4).position(|window| window == b"\r\n\r\n") {
            break (String::from_utf8_lossy(&bytes[..at]).to_lowercase(), bytes[at + 4..].to_vec());
        }
    };
    let length: usize =
        head.lines().find_map(|line| line.strip_prefix("content-length:"))?.trim().parse().ok()?;
    let mut body = rest;
    while body.len() < length {
        let n = stream.read(&mut buffer).ok().filter(|n| *n > 0)?;
        body.extend_from_slice(&buffer[..n]);
    }
    Some((head, serde_json::from_slice(&body).ok()?))
}

fn act(stream: &mut TcpStream, act: Act) {
    match act {
        Act::Answer(status, headers, body) => {
            let mut head =
                format!("HTTP/1.1 {status} X\r\ncontent-length: {}\r\nconnection: close\r\n", body.len());
            for (name, value) in headers {
                head.push_str(&format!("{name}: {value}\r\n"));
            }
            let _ = stream.write_all(format!("{head}\r\n").as_bytes());
            let _ = stream.write_all(&body);
        }
        Act::Truncate => {
            let _ = stream.write_all(b"HTTP/1.1 200 OK\r\ncontent-length: 500\r\n\r\n{\"choices\":[{\"mess");
        }
        Act::Hang(time) => std::thread::sleep(time),
        Act::Close => {}
    }
}

fn says(content: &str) -> Act {
    let body = json!({
        "choices": [{"message": {"role": "assistant", "content": content}}],
        "usage": {"prompt_tokens": 100, "completion_tokens": 20, "total_tokens": 120}
    });
    Act::Answer(200, Vec::new(), body.to_string().into_bytes())
}

fn refuses(status: u16, text: &str) -> Act {
    Act::Answer(status, Vec::new(), json!({"error": {"message": text}}).to_string().into_bytes())
}

const GOOD: &str = r#"{"subtasks":[{"id":"s1","text":"apple","goal":[{"object":"Fridge","contains":["Apple"]}],"after":[]}],"confidence":0.9}"#;

fn request() -> Request {
    let object = |kind: &str, affordances: &[&str], accepts: &[&str]| ObjectView {
        name: format!("{kind}_1"),
        kind: kind.to_owned(),
        affordances: affordances.iter().map(|a| (*a).to_owned()).collect(),
        accepts: accepts.iter().map(|a| (*a).to_owned()).collect(),
        ..ObjectView::default()
    };
    Request {
        instruction: "put the apple into the fridge".to_owned(),
        objects: vec![
            object("Apple", &["pickupable", "sliceable"], &[]),
            object("Fridge", &["receptacle", "openable", "isColdSource"], &["Apple"]),
        ],
        robots: vec![RobotView { name: "robot1".to_owned(), ..RobotView::default() }],
        assume: false,
        deadline: Duration::from_secs(20),
    }
}

fn ask(model: &mut dyn LanguageModel) -> Result<Answer, LmError> {
    model.decompose(&request(), &AtomicBool::new(false))
}

#[track_caller]
fn assert_understood(answer: Result<Answer, LmError>) {
    match answer {
        Ok(Answer::Understood(decomposition)) => assert_eq!(decomposition.subtasks.len(), 1),
        other => panic!("not understood: {other:?}"),
    }
}

#[test]
fn a_good_answer_is_taken_and_accounted_for() {
    let server = Server::start(Box::new(|_, _| says(GOOD)));
    let mut model = server.model(0);
    assert_understood(ask(&mut model));
    let usage = model.usage();
    assert_eq!(
        (usage.requests, usage.prompt_tokens, usage.completion_tokens, usage.estimated),
        (1, 100, 20, false)
    );
    let (head, body) = &server.requests()[0];
    assert!(head.starts_with("post /v1/chat/completions"), "{head}");
    assert!(head.contains("authorization: bearer secret"), "the key goes into the header");
    assert_eq!(body["response_format"]["type"], "json_schema");
    assert!(!body.to_string().contains("secret"), "the key goes nowhere else");
}

#[test]
fn a_server_without_schemas_is_asked_for_less_and_it_is_remembered() {
    let server = Server::start(Box::new(|_, body| match body["response_format"]["type"].as_str() {
        Some("json_schema") => refuses(500, "Input should be 'text' or 'json_object'"),
        Some("json_object") => refuses(400, "response_format is not supported"),
        _ => says(&format!("Here you are:\n```json\n{GOOD}\n```\nAnything else?")),
    }));
    let mut model = server.model(0);
    assert_understood(ask(&mut model));
    assert_understood(ask(&mut model));
    assert_eq!(server.requests().len(), 4, "three rungs the first time, the last at once the second time");
}

#[test]
fn a_refused_parameter_is_left_out() {
    let server = Server::start(Box::new(|_, body| {
        if body.get("temperature").is_some() {
            refuses(400, "Unsupported parameter: 'temperature'")
        } else {
            says(GOOD)
        }
    }));
    assert_understood(ask(&mut server.model(0)));
    assert_eq!(server.requests()[1].1["response_format"]["type"], "json_schema", "the form stays");
}

#[test]
fn passing_errors_are_tried_again_as_the_server_asks() {
    let server = Server::start(Box::new(|n, _| match n {
        1 => Act::Answer(429, vec![("retry-after", "0.01".to_owned())], b"slow down".to_vec()),
        2 => Act::Answer(503, Vec::new(), b"busy".to_vec()),
        3 => Act::Truncate,
        4 => Act::Close,
        _ => says(GOOD),
    }));
    assert_understood(ask(&mut server.model(4)));
    assert_eq!(server.requests().len(), 5);
}

#[test]
fn lasting_errors_are_not_tried_again() {
    let server = Server::start(Box::new(|_, _| refuses(401, "no key")));
    let error = ask(&mut server.model(3)).unwrap_err();
    assert!(error.to_string().contains("key"), "{error}");
    assert_eq!(server.requests().len(), 1);
}

#[test]
fn a_wait_that_is_longer_than_the_deadline_ends_at_once() {
    let server = Server::start(Box::new(|_, _| {
        Act::Answer(429, vec![("retry-after", "3600".to_owned())], Vec::new())
    }));
    let started = Instant::now();
    assert!(matches!(ask(&mut server.model(3)), Err(LmError::Endpoint(_))));
    assert!(started.elapsed() < Duration::from_secs(15));
}

#[test]
fn the_deadline_is_kept_by_a_server_that_never_answers() {
    let server = Server::start(Box::new(|_, _| Act::Hang(Duration::from_secs(30))));
    let mut request = request();
    request.deadline = Duration::from_millis(200);
    let started = Instant::now();
    let result = server.model(5).decompose(&request, &AtomicBool::new(false));
    assert!(matches!(result, Err(LmError::Deadline(_))), "{result:?}");
    assert!(started.elapsed() < Duration::from_secs(15), "it must not wait for the server");
}

#[test]
fn cancelling_ends_a_request_under_way() {
    let server = Server::start(Box::new(|_, _| Act::Hang(Duration::from_secs(30))));
    let cancel = Arc::new(AtomicBool::new(false));
    let setter = Arc::clone(&cancel);
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(100));
        setter.store(true, Ordering::Relaxed);
    });
    assert!(matches!(server.model(0).decompose(&request(), &cancel), Err(LmError::Cancelled)));
}

#[test]
fn what_is_wrong_is_sent_back_and_the_tries_are_bounded() {
    let unknown = GOOD.replace("Apple", "Aple");
    let answer = unknown.clone();
    let server = Server::start(Box::new(move |n, _| if n == 1 { says(&answer) } else { says(GOOD) }));
    assert_understood(ask(&mut server.model(0)));
    let sent_back = server.requests()[1].1["messages"].to_string();
    assert!(
        sent_back.contains("did you mean \\\\\\\"Apple\\\\\\\"?") || sent_back.contains("did you mean"),
        "{sent_back}"
    );

    let server = Server::start(Box::new(move |_, _| says(&unknown)));
    match ask(&mut server.model(0)) {
        Err(LmError::Unusable { tries: 3, last }) => assert!(last.contains("Aple"), "{last}"),
        other => panic!("{other:?}"),
    }
    assert_eq!(server.requests().len(), 3);
}

#[test]
fn nonsense_and_floods_are_refused_by_name() {
    let deep = "[".repeat(100_000);
    let cases: Vec<(String, &str)> = vec![
        ("no".to_owned(), "no JSON object"),
        ("{\"subtasks\": 3}".to_owned(), "not the format"),
        ("{\"subtasks\": [], \"extra\": 1}".to_owned(), "extra"),
        (format!("{{\"subtasks\": {deep}"), "bytes"),
        (format!("{{\"subtasks\": {}}}", "[".repeat(1000)), "not the format"),
        (GOOD.replace("\"after\":[]", "\"after\":[\"s1\"]"), "before itself"),
        (GOOD.replace("\"after\":[]", "\"after\":[\"s9\"]"), "s9"),
        (GOOD.replace("\"after\":[]", "\"robots\":[\"robot7\"]"), "robot7"),
        (GOOD.replace("\"contains\":[\"Apple\"]", "\"is\":{\"isOpn\":true}"), "isOpn"),
        (GOOD.replace("\"contains\":[\"Apple\"]", "\"is\":{\"isOpen\":\"Hot\"}"), "true or false"),
        (GOOD.replace("0.9", "7"), "confidence"),
    ];
    for (content, expected) in cases {
        let errors = lamma_lm::decode::decode(&content, &request()).unwrap_err().join("; ");
        assert!(errors.contains(expected), "{expected:?} is not in {errors:?}");
    }
}

#[test]
fn what_nobody_may_do_is_taken_if_it_can_be_done() {
    let forbidding = |skill: &str, object: &str| {
        let bans = format!("\"bans\":[{{\"skill\":\"{skill}\",\"object\":\"{object}\"}}],\"subtasks\"");
        GOOD.replacen("\"subtasks\"", &bans, 1)
    };
    let good = forbidding("SliceObject", "Apple");
    let server = Server::start(Box::new(move |_, _| says(&good)));
    match ask(&mut server.model(0)) {
        Ok(Answer::Understood(decomposition)) => {
            let bans: Vec<_> = decomposition.bans.iter().map(|ban| (&*ban.skill, &*ban.object)).collect();
            assert_eq!(bans, [("SliceObject", "Apple")]);
        }
        other => panic!("not understood: {other:?}"),
    }
    for (skill, object, what) in [("SlisceObject", "Apple", "SliceObject"), ("SliceObject", "Sink", "Sink")] {
        let bad = forbidding(skill, object);
        let server = Server::start(Box::new(move |_, _| says(&bad)));
        let error = ask(&mut server.model(0)).expect_err("it cannot be done").to_string();
        assert!(error.contains("bans[0]") && error.contains(what), "{error}");
    }
}

#[test]
fn a_huge_body_is_not_read() {
    let server = Server::start(Box::new(|_, _| Act::Answer(200, Vec::new(), vec![b'x'; 3 << 20])));
    assert!(matches!(ask(&mut server.model(0)), Err(LmError::Endpoint(_))));
}

#[test]
fn a_question_is_handed_on() {
    let server = Server::start(Box::new(|_, _| says("{\"question\":\"which apple?\"}")));
    assert!(matches!(ask(&mut server.model(0)), Ok(Answer::Clarify(c)) if c.question == "which apple?"));
}

#[test]
fn the_embedded_default_steps_in_and_says_so() {
    let server = Server::start(Box::new(|_, _| says("I would rather not.")));
    let mut model = Fallback::new(server.model(0), Offline::new().unwrap());
    match ask(&mut model) {
        Ok(Answer::Understood(decomposition)) => {
            assert!(
                decomposition.assumptions[0].contains("embedded default"),
                "{:?}",
                decomposition.assumptions
            );
            assert_eq!(decomposition.subtasks.len(), 1);
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(model.usage().requests, 3, "what the model used is accounted for");
}

#[test]
fn a_cassette_plays_back_what_was_recorded() {
    let path = std::env::temp_dir().join(format!("lamma-cassette-{}.jsonl", std::process::id()));
    let _ = std::fs::remove_file(&path);
    let server = Server::start(Box::new(|_, _| says(GOOD)));
    let record = Record::new(server.http(0), &path).unwrap();
    let recorded = ask(&mut ChatModel::new(record, "tiny".to_owned(), 2, 1)).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        !text.contains("secret") && !text.contains("127.0.0.1"),
        "neither key nor endpoint is written down"
    );

    let replay = Replay::read(&path).unwrap();
    let mut model = ChatModel::new(replay, "tiny".to_owned(), 2, 1);
    assert_eq!(ask(&mut model).unwrap(), recorded);
    let mut other = request();
    other.instruction = "slice the apple".to_owned();
    let error = model.decompose(&other, &AtomicBool::new(false)).unwrap_err();
    assert!(matches!(&error, LmError::Configuration(text) if text.contains("record")), "{error}");

    let options = Options { seed: 1, ..Options::default() };
    let mut named = from_spec(&format!("replay:{}", path.display()), &options).unwrap();
    assert_eq!(ask(named.as_mut()).unwrap(), recorded, "the model's name comes from the cassette");
    let _ = std::fs::remove_file(&path);
}

#[test]
fn wrong_settings_say_what_to_do() {
    let options = Options { base_url: Some("localhost:8080".to_owned()), ..Options::default() };
    for (spec, options, expected) in [
        ("gpt", Options::default(), "offline"),
        ("replay:/no/such/file", Options::default(), "record"),
        ("openai", options, "http://"),
    ] {
        let error = from_spec(spec, &options).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{spec}: {error}");
    }
    assert_eq!(from_spec("offline", &Options::default()).unwrap().name(), "offline");
}
