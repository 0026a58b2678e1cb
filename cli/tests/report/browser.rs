//! A page in headless Chromium, spoken to by the DevTools protocol over a pair of pipes: JSON messages that end in a zero byte.
//!
//! Every wait has an end, and the browser dies with the test.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Longest wait for an answer: a browser that starts on a busy machine takes seconds.
const PATIENCE: Duration = Duration::from_secs(60);

/// Between two looks at a page.
const PAUSE: Duration = Duration::from_millis(20);

/// A browser with one page.
pub struct Browser {
    process: Child,
    commands: ChildStdin,
    messages: Receiver<Value>,
    session: Value,
    next_id: u64,
    /// What the page has said on its console, and exceptions that nobody caught.
    pub console: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts Chromium with a page `width` pixels wide: the environment's `CHROMIUM`, or one of the usual names.
    pub fn start(width: u32) -> Browser {
        let names = std::env::var("CHROMIUM").into_iter();
        let names = names.chain(["chromium", "chromium-browser", "google-chrome"].map(String::from));
        let answers =
            |name: &String| Command::new(name).arg("--version").output().is_ok_and(|one| one.status.success());
        let name = names.into_iter().find(answers).expect("Chromium; CHROMIUM names one");
        let profile = tempfile::tempdir().expect("a folder");
        // The browser reads commands from descriptor 3 and answers on 4. Root has no sandbox, containers no large /dev/shm.
        let mut process = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 >/dev/null 2>&1 </dev/null", &name])
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"])
            .args(["--remote-debugging-pipe", "--hide-scrollbars"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell");
        let commands = process.stdin.take().expect("piped");
        let answers = BufReader::new(process.stdout.take().expect("piped"));
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            for message in answers.split(0).map_while(Result::ok) {
                let read = serde_json::from_slice(&message).expect("the protocol is JSON");
                if sender.send(read).is_err() {
                    break;
                }
            }
        });
        let mut browser = Browser {
            process,
            commands,
            messages,
            session: Value::Null,
            next_id: 0,
            console: Vec::new(),
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }))["targetId"].clone();
        let attached = browser.call("Target.attachToTarget", json!({ "targetId": target, "flatten": true }));
        browser.session = attached["sessionId"].clone();
        for domain in ["Page.enable", "Runtime.enable", "Log.enable"] {
            browser.call(domain, json!({}));
        }
        let screen = json!({ "width": width, "height": 844, "deviceScaleFactor": 2, "mobile": width < 600 });
        browser.call("Emulation.setDeviceMetricsOverride", screen);
        browser
    }

    /// The result of a command that must succeed.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.ask(method, parameters).unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// What the browser answers to a command, or its error.
    fn ask(&mut self, method: &str, parameters: Value) -> Result<Value, Value> {
        self.next_id += 1;
        let mut command = json!({ "id": self.next_id, "method": method, "params": parameters });
        if !self.session.is_null() {
            command["sessionId"] = self.session.clone();
        }
        self.commands.write_all(format!("{command}\0").as_bytes()).expect("the browser listens");
        loop {
            let message = self.messages.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("no answer to {method}"));
            if message["id"] == self.next_id {
                return if message["error"].is_null() {
                    Ok(message["result"].clone())
                } else {
                    Err(message["error"].clone())
                };
            }
            if ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"]
                .iter()
                .any(|event| message["method"] == *event)
            {
                self.console.push(message["params"].to_string());
            }
        }
    }

    /// Opens a file with a query and waits until the page has drawn.
    pub fn open(&mut self, file: &Path, query: &str) {
        let file = file.canonicalize().expect("written");
        let url = json!(format!("file://{}?{query}", file.display()));
        self.call("Page.navigate", json!({ "url": url }));
        self.wait(&format!("location.href === {url} && document.documentElement.dataset.done === 'true'"));
    }

    /// Waits until an expression is true; while a page is loading it may fail.
    pub fn wait(&mut self, condition: &str) {
        let start = Instant::now();
        let question = json!({ "expression": condition, "returnByValue": true });
        while !self.ask("Runtime.evaluate", question.clone()).is_ok_and(|answer| answer["result"]["value"] == true) {
            assert!(start.elapsed() < PATIENCE, "never came true: {condition}; console: {:?}", self.console);
            std::thread::sleep(PAUSE);
        }
    }

    /// The value of an expression in the page.
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let answer = self.call("Runtime.evaluate", json!({ "expression": expression, "returnByValue": true }));
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {}", answer["exceptionDetails"]);
        answer["result"]["value"].clone()
    }

    /// The time drawn `[s]`.
    pub fn time(&mut self) -> f64 {
        self.evaluate("Number(document.documentElement.dataset.t)").as_f64().expect("a number")
    }

    /// Presses and releases a key, as the browser names it.
    pub fn press(&mut self, key: &str, shift: bool) {
        for kind in ["keyDown", "keyUp"] {
            let text = if key == " " && kind == "keyDown" { " " } else { "" };
            let event = json!({ "type": kind, "key": key, "modifiers": if shift { 8 } else { 0 }, "text": text });
            self.call("Input.dispatchKeyEvent", event);
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The process may be gone already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
