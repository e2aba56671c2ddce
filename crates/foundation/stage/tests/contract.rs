//! The invariants that the crate's documentation states, each by a test that breaks if it does.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are not in a test function")]

mod example;

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant, SystemTime};

use biplane_artifact::Content;
use biplane_stage::{
    Clean, Context, ExecuteError, Hashed, How, Inputs, Item, KeyParts, Outcome, ParamsError, ParamsText,
    Promised, Reason, Stage, Store, StoreError,
};
use example::{Join, JoinInputs, JoinParams, OtherCode, OtherName, Text, Trim, TrimInputs, TrimParams};

struct Study {
    folder: tempfile::TempDir,
    store: Store,
}

impl Study {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(&folder.path().join(".biplane")).unwrap();
        Self { folder, store }
    }

    fn join(&self, item: &str, params: &JoinParams, inputs: &JoinInputs) -> Outcome<Text> {
        let text = ParamsText::of(params).unwrap();
        let load = || Ok::<_, StoreError>(inputs.clone());
        self.store
            .execute::<Join, _>("join", &Item::from(item), &text, &inputs.hashes(), load, &Context::new())
            .unwrap()
    }

    fn explain(&self, item: &str, params: &JoinParams, inputs: &JoinInputs) -> String {
        let parts = KeyParts::of::<Join>(&ParamsText::of(params).unwrap(), inputs);
        self.store.explain::<Join>("join", &Item::from(item), &parts).unwrap().to_string()
    }
}

fn inputs(head: &str, tail: &[&str]) -> JoinInputs {
    let text = |t: &str| Hashed::new(Text(t.to_owned()));
    JoinInputs { head: text(head), tail: tail.iter().map(|t| text(t)).collect(), other: vec![] }
}

fn params() -> JoinParams {
    JoinParams::default()
}

/// Every file below a folder, with its bytes.
fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![dir.to_path_buf()];
    while let Some(next) = waiting.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.symlink_metadata().unwrap().is_dir() {
                waiting.push(path);
            } else if path.is_file() {
                found.insert(path.strip_prefix(dir).unwrap().to_path_buf(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

#[test]
fn the_key_changes_with_every_part() {
    let text = |p: &JoinParams| ParamsText::of(p).unwrap();
    let key = |p: &JoinParams, i: &JoinInputs| KeyParts::of::<Join>(&text(p), i).key();
    let base = inputs("a", &["b", "c"]);
    let moved = JoinInputs { tail: vec![], other: base.tail.clone(), ..base.clone() };
    let split = JoinInputs { tail: base.tail[..1].to_vec(), other: base.tail[1..].to_vec(), ..base.clone() };
    let keys = [
        key(&params(), &base),
        key(&JoinParams { separator: "-".into(), ..params() }, &base),
        key(&params(), &inputs("A", &["b", "c"])),
        key(&params(), &inputs("a", &["b", "d"])),
        key(&params(), &inputs("a", &["c", "b"])),
        key(&params(), &inputs("a", &["b"])),
        key(&params(), &inputs("a", &["b", "c", "c"])),
        key(&params(), &inputs("b", &["a", "c"])),
        key(&params(), &moved),
        key(&params(), &split),
        KeyParts::of::<OtherName>(&text(&params()), &base).key(),
        KeyParts::of::<OtherCode>(&text(&params()), &base).key(),
    ];
    for (i, a) in keys.iter().enumerate() {
        for (j, b) in keys.iter().enumerate() {
            assert_eq!(i == j, a == b, "keys {i} and {j}");
        }
    }
    assert_eq!(
        keys[0],
        KeyParts::of::<Join>(&text(&params()), &base.hashes()).key(),
        "hashes alone give the same key"
    );
}

#[test]
fn the_role_kind_and_schema_of_an_input_and_of_the_output_are_in_the_key() {
    let value = serde_json::json!({});
    let params = ParamsText::of(&value).unwrap();
    let hash = Text(String::new()).content_hash();
    let keys = example::keys_that_differ_in_role_kind_or_schema_alone(&params, hash);
    for (i, a) in keys.iter().enumerate() {
        assert_eq!(keys.iter().position(|b| b == a), Some(i));
    }
}

#[test]
fn spelled_out_defaults_comments_and_order_of_keys_do_not_change_the_key() {
    let of = |json: &str| ParamsText::of(&serde_json::from_str::<JoinParams>(json).unwrap()).unwrap();
    assert_eq!(of("{}").as_str(), r#"{"limit":{"longest":100,"scale":1.5},"separator":", "}"#);
    assert_eq!(of(r#"{ "separator": ", ", "limit": { "scale": 1.5, "longest": 100 } }"#), of("{}"));
    assert_ne!(of(r#"{ "limit": { "scale": 1.25 } }"#), of("{}"));
    assert!(serde_json::from_str::<JoinParams>(r#"{ "seperator": "" }"#).is_err());

    let maps = (0..20).map(|_| (0..50).map(|i| (format!("key {i}"), i)).collect::<HashMap<_, _>>());
    let texts: Vec<_> = maps.map(|m| ParamsText::of(&m).unwrap()).collect();
    assert!(texts.iter().all(|t| *t == texts[0]), "a map's order got into the text");
}

#[test]
fn parameters_that_do_not_survive_writing_are_refused() {
    assert!(matches!(ParamsText::of(&f64::NAN), Err(ParamsError::NotJson(_))));
    assert!(matches!(ParamsText::of(&vec![f64::INFINITY]), Err(ParamsError::NotJson(_))));
    let error = ParamsText::of(&example::Drifting(1)).unwrap_err().to_string();
    assert!(error.contains("2 became 3"), "{error}");
    for x in [0.1, 1.0 / 3.0, 1e-300, f64::MAX, -0.0] {
        let text = ParamsText::of(&x).unwrap();
        assert_eq!(serde_json::from_str::<f64>(text.as_str()).unwrap().to_bits(), x.to_bits());
    }
}

#[test]
fn a_second_run_finds_the_entry_and_loads_nothing() {
    let study = Study::new();
    let i = inputs("a", &["b", "c"]);
    let first = study.join("lunge/0017", &params(), &i);
    assert_eq!(first.how, How::Ran);
    assert_eq!(*first.output.load().unwrap(), Text("a, b, c".into()));

    let text = ParamsText::of(&params()).unwrap();
    let load = || -> Result<JoinInputs, StoreError> { panic!("loaded the inputs of a cached item") };
    let item = Item::from("lunge/0017");
    let again =
        study.store.execute::<Join, _>("join", &item, &text, &i.hashes(), load, &Context::new()).unwrap();
    assert_eq!(again.how, How::Cached);
    assert_eq!((again.output.hash(), again.output.path()), (first.output.hash(), first.output.path()));
    assert_eq!(first.output.hash(), first.output.load().unwrap().content_hash());
}

#[test]
fn a_cached_lookup_does_not_read_the_output() {
    let study = Study::new();
    let output = study.join("x", &params(), &inputs("a", &["b"])).output;
    fs::write(output.path(), "A, B").unwrap();
    assert_eq!(study.join("x", &params(), &inputs("a", &["b"])).how, How::Cached);
}

#[test]
fn steps_lead_to_entries_that_say_what_made_them() {
    let study = Study::new();
    let i = inputs("a", &["b"]);
    let output = study.join("lunge/0017/femur", &params(), &i).output;
    let link = study.folder.path().join(".biplane/steps/join/lunge/0017/femur");
    assert_eq!(link, study.store.link_path("join", &Item::from("lunge/0017/femur")));
    #[cfg(unix)]
    {
        assert!(fs::read_link(&link).unwrap().is_relative());
        assert_eq!(fs::read_to_string(link.join("output.txt")).unwrap(), "a, b");
    }
    let record = fs::read_to_string(output.path().with_file_name("entry.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let hash = |t: &str| Text(t.to_owned()).content_hash().to_hex();
    assert_eq!(
        record,
        serde_json::json!({
            "format": 1,
            "stage": "join",
            "code": "1",
            "params": { "separator": ", ", "limit": { "longest": 100, "scale": 1.5 } },
            "inputs": [
                { "role": "head", "kind": "text", "schema": 1, "hash": hash("a") },
                { "role": "tail", "kind": "text", "schema": 1, "hash": [hash("b")] },
                { "role": "other", "kind": "text", "schema": 1, "hash": [] },
            ],
            "output": { "kind": "text", "schema": 1, "file": "output.txt", "bytes": 4, "hash": hash("a, b") },
        })
    );
    let tag = fs::read_to_string(study.store.dir().join("CACHEDIR.TAG")).unwrap();
    // The first 43 bytes that https://bford.info/cachedir/ asks for.
    assert!(tag.starts_with("Signature: 8a477f597d28d172789f06886806bc55"));
}

#[cfg(unix)]
#[test]
fn a_link_follows_the_latest_run_of_its_item() {
    let study = Study::new();
    let (a, b) = (inputs("a", &[]), inputs("b", &[]));
    let text =
        || fs::read_to_string(study.store.link_path("join", &Item::from("x")).join("output.txt")).unwrap();
    study.join("x", &params(), &a);
    study.join("x", &params(), &b);
    assert_eq!(text(), "b");
    assert_eq!(study.join("x", &params(), &a).how, How::Cached);
    assert_eq!(text(), "a");
    assert_eq!(study.store.size().unwrap().entries, 2);
}

#[test]
fn names_of_items_stay_in_their_folder() {
    let study = Study::new();
    let before = fs::read_dir(study.folder.path()).unwrap().count();
    for item in
        [Item::from("../../x"), Item::of(["../../x"]), Item::of(["/tmp/x"]), Item::of([".."]), Item::of([""])]
    {
        let text = ParamsText::of(&params()).unwrap();
        let i = inputs("a", &[]);
        for step in ["join", "..", "../../../x"] {
            if item.parts().len() == 1 {
                let load = || Ok::<_, StoreError>(i.clone());
                study
                    .store
                    .execute::<Join, _>(step, &item, &text, &i.hashes(), load, &Context::new())
                    .unwrap();
            }
        }
    }
    assert_eq!(fs::read_dir(study.folder.path()).unwrap().count(), before);
    assert_eq!(fs::read_dir(study.store.dir()).unwrap().count(), 4, "CACHEDIR.TAG, entries, steps, tmp");
    assert_eq!(fs::read_dir(study.store.dir().join("steps/join")).unwrap().count(), 4);
}

#[test]
fn an_item_in_the_way_of_another_is_an_error_that_names_it() {
    let study = Study::new();
    study.join("lunge", &params(), &inputs("a", &[]));
    study.join("squat/1", &params(), &inputs("a", &[]));
    let text = ParamsText::of(&params()).unwrap();
    for item in ["lunge/0017", "lunge/0017/femur", "squat", ""] {
        let i = inputs("b", &[]);
        let load = || Ok::<_, StoreError>(i.clone());
        let error = study
            .store
            .execute::<Join, _>("join", &Item::from(item), &text, &i.hashes(), load, &Context::new())
            .unwrap_err();
        assert!(matches!(&error, ExecuteError::Store(StoreError::ItemClash { .. })), "{item}: {error}");
        assert!(error.to_string().contains("same number of parts"), "{error}");
    }
    assert_eq!(fs::read_dir(study.store.dir().join("tmp")).unwrap().count(), 0);
}

#[test]
fn the_same_bytes_upstream_leave_what_follows_cached() {
    let study = Study::new();
    let chain = |raw: &str, suffix: &str| {
        let raw = TrimInputs { raw: Hashed::new(Text(raw.into())) };
        let text = ParamsText::of(&TrimParams { suffix: suffix.into() }).unwrap();
        let load = || Ok::<_, StoreError>(raw.clone());
        let context = Context::new();
        let trimmed = study
            .store
            .execute::<Trim, _>("trim", &Item::from("x"), &text, &raw.hashes(), load, &context)
            .unwrap();
        let hashes = JoinInputs::<Promised> { head: trimmed.output.promise(), tail: vec![], other: vec![] };
        let load =
            || Ok::<_, StoreError>(JoinInputs { head: trimmed.output.load()?, tail: vec![], other: vec![] });
        let text = ParamsText::of(&params()).unwrap();
        let joined =
            study.store.execute::<Join, _>("join", &Item::from("x"), &text, &hashes, load, &context).unwrap();
        (trimmed.how, joined.how)
    };
    assert_eq!(chain("  a", ""), (How::Ran, How::Ran));
    assert_eq!(chain("a  ", ""), (How::Ran, How::Cached), "another input, the same output");
    assert_eq!(chain("a", " "), (How::Ran, How::Cached), "another parameter, the same output");
    assert_eq!(chain("b", ""), (How::Ran, How::Ran));
}

#[test]
fn inputs_that_changed_after_the_key_was_made_are_refused() {
    let study = Study::new();
    let text = ParamsText::of(&params()).unwrap();
    let promised = inputs("a", &["b", "c"]).hashes();
    for (loaded, named) in [
        (inputs("A", &["b", "c"]), "head"),
        (inputs("a", &["b", "C"]), "tail[1]"),
        (inputs("a", &["b"]), "tail"),
        (inputs("a", &["c", "b"]), "tail"),
    ] {
        let load = || Ok::<_, StoreError>(loaded);
        let error = study
            .store
            .execute::<Join, _>("join", &Item::from("x"), &text, &promised, load, &Context::new())
            .unwrap_err();
        assert!(matches!(&error, ExecuteError::InputChanged { role } if role == named), "{named}: {error}");
    }
    assert_eq!(study.store.size().unwrap().entries, 0);
}

#[test]
fn a_failed_stage_or_load_stores_nothing_and_keeps_what_was() {
    let study = Study::new();
    study.join("x", &params(), &inputs("a", &[]));
    let before = files(study.store.dir());
    let text = ParamsText::of(&params()).unwrap();
    let i = inputs("fail", &[]);
    let load = || Ok::<_, StoreError>(i.clone());
    let run = |text: &ParamsText, load: &dyn Fn() -> Result<JoinInputs, StoreError>| {
        study
            .store
            .execute::<Join, _>("join", &Item::from("x"), text, &i.hashes(), load, &Context::new())
            .unwrap_err()
    };
    assert!(matches!(run(&text, &load), ExecuteError::Stage(_)));
    let missing = study.join("y", &params(), &inputs("y", &[])).output;
    study.store.discard(missing.key()).unwrap();
    let load = || Err(missing.load().unwrap_err());
    assert!(matches!(run(&text, &load), ExecuteError::Load(StoreError::Damaged(_))));
    let other = ParamsText::of(&vec![1, 2]).unwrap();
    assert!(matches!(
        run(&other, &|| panic!("loaded for parameters of another stage")),
        ExecuteError::Params(_)
    ));
    assert_eq!(files(study.store.dir()), before);
    assert!(
        study.explain("x", &params(), &i).contains("input head changed"),
        "the earlier result is still known"
    );
}

#[test]
fn an_artifact_that_does_not_read_back_or_hashes_something_else_is_refused() {
    let study = Study::new();
    let text = ParamsText::of(&()).unwrap();
    let load = || Ok::<_, StoreError>(());
    let error = study
        .store
        .execute::<example::Liar, _>("liar", &Item::whole(), &text, &(), load, &Context::new())
        .unwrap_err();
    assert!(matches!(error, ExecuteError::Store(StoreError::HashOfAnotherFile { kind: "lie" })), "{error}");
    let error = study
        .store
        .execute::<example::Mute, _>("mute", &Item::whole(), &text, &(), load, &Context::new())
        .unwrap_err();
    assert!(
        error.to_string().contains("cannot be read back") && error.to_string().contains("mute"),
        "{error}"
    );
    assert_eq!(study.store.size().unwrap().entries, 0);
}

#[test]
fn a_cancelled_context_runs_nothing_and_keeps_nothing() {
    let study = Study::new();
    let text = ParamsText::of(&params()).unwrap();
    let i = inputs("a", &[]);
    let context = Context::new();
    let run = |context: &Context, load: &dyn Fn() -> Result<JoinInputs, StoreError>| {
        study.store.execute::<Join, _>("join", &Item::from("x"), &text, &i.hashes(), load, context)
    };
    // Cancelled while the item is under way: what the stage gave may be half a result.
    let load = || {
        context.clone().cancel();
        Ok(i.clone())
    };
    assert!(matches!(run(&context, &load), Err(ExecuteError::Cancelled)));
    assert!(matches!(run(&context, &|| panic!("loaded though cancelled")), Err(ExecuteError::Cancelled)));
    assert_eq!(study.store.size().unwrap().entries, 0);
    run(&Context::new(), &|| Ok(i.clone())).unwrap();
    assert_eq!(run(&context, &|| panic!("cached")).unwrap().how, How::Cached, "what is there may be used");
}

#[test]
fn a_truncated_output_is_found_by_the_lookup_and_made_again() {
    let study = Study::new();
    let i = inputs("a", &["b", "c"]);
    let output = study.join("x", &params(), &i).output;
    for damage in [
        (|p: &Path| fs::write(p, "a, b").unwrap()) as fn(&Path),
        |p| fs::remove_file(p).unwrap(),
        |p| fs::write(p.with_file_name("entry.json"), "{").unwrap(),
        |p| fs::write(p.with_file_name("entry.json"), "").unwrap(),
        |p| fs::remove_file(p.with_file_name("entry.json")).unwrap(),
    ] {
        damage(output.path());
        let explained = study.explain("x", &params(), &i);
        assert!(explained.starts_with("join/x: entry damaged: "), "{explained}");
        let again = study.join("x", &params(), &i);
        assert!(matches!(again.how, How::Remade(_)), "{:?}", again.how);
        assert_eq!(*again.output.load().unwrap(), Text("a, b, c".into()));
        assert_eq!(study.join("x", &params(), &i).how, How::Cached);
    }
    fs::write(output.path(), "a, b").unwrap();
    let How::Remade(damage) = study.join("x", &params(), &i).how else { panic!("not remade") };
    assert_eq!(damage.what, "output.txt has 4 bytes, 7 were written");
    assert_eq!(fs::read_dir(study.store.dir().join("tmp")).unwrap().count(), 0);
}

#[test]
fn a_flipped_byte_is_found_when_the_output_is_loaded() {
    let study = Study::new();
    let i = inputs("a", &["b", "c"]);
    let output = study.join("x", &params(), &i).output;
    let mut bytes = fs::read(output.path()).unwrap();
    for at in 0..bytes.len() {
        bytes[at] ^= 1;
        fs::write(output.path(), &bytes).unwrap();
        bytes[at] ^= 1;
        assert!(matches!(output.load(), Err(StoreError::Damaged(_))), "byte {at}");
    }
    study.store.discard(output.key()).unwrap();
    study.store.discard(output.key()).unwrap();
    assert_eq!(study.join("x", &params(), &i).how, How::Ran);
    assert_eq!(*output.load().unwrap(), Text("a, b, c".into()));
}

#[test]
fn no_change_of_a_record_gives_a_wrong_value() {
    let study = Study::new();
    let output = study.join("x", &params(), &inputs("a", &["b"])).output;
    let record = output.path().with_file_name("entry.json");
    let text = fs::read(&record).unwrap();
    for at in 0..text.len() {
        for mask in [1, 16] {
            let mut changed = text.clone();
            changed[at] ^= mask;
            fs::write(&record, &changed).unwrap();
            match study.store.get::<Text>(output.key()).map(|found| found.unwrap().load()) {
                Ok(Ok(value)) => assert_eq!(*value, Text("a, b".into())),
                Ok(Err(StoreError::Damaged(_))) | Err(StoreError::Damaged(_)) => {}
                other => panic!("byte {at}: {other:?}"),
            }
            let parts = KeyParts::of::<Join>(&ParamsText::of(&params()).unwrap(), &inputs("c", &[]));
            study.store.explain::<Join>("join", &Item::from("x"), &parts).unwrap();
        }
    }
}

#[test]
fn what_a_killed_run_left_is_ignored_and_removed_later() {
    let study = Study::new();
    let tmp = study.store.dir().join("tmp");
    let (old, new) = (tmp.join("1-old"), tmp.join("2-new"));
    for dir in [&old, &new] {
        fs::create_dir(dir).unwrap();
        fs::write(dir.join("output.txt"), "half of").unwrap();
    }
    let two_hours_ago = SystemTime::now() - Duration::from_secs(7200);
    fs::File::open(&old).unwrap().set_modified(two_hours_ago).unwrap();
    let i = inputs("a", &[]);
    assert_eq!(study.join("x", &params(), &i).how, How::Ran);
    Store::open(study.store.dir()).unwrap();
    assert!(!old.exists() && new.exists(), "another run may be writing the new one");
}

fn long_inputs(n: usize) -> JoinInputs {
    inputs(&n.to_string(), &[&"x".repeat(100_000)])
}

/// Not a test by itself: what `a_run_that_is_killed_leaves_no_half_entry` starts and kills.
#[test]
fn child_that_writes_until_killed() {
    let Some(dir) = std::env::var_os("BIPLANE_TEST_STORE") else { return };
    let store = Store::open(Path::new(&dir)).unwrap();
    let text = ParamsText::of(&params()).unwrap();
    for n in 0..1_000_000 {
        let i = long_inputs(n);
        let load = || Ok::<_, StoreError>(i.clone());
        let item = Item::of([n.to_string()]);
        store.execute::<Join, _>("join", &item, &text, &i.hashes(), load, &Context::new()).unwrap();
    }
}

#[test]
fn a_run_that_is_killed_leaves_no_half_entry() {
    let study = Study::new();
    let entries = study.store.dir().join("entries");
    let outputs = || files(&entries).keys().filter(|p| p.ends_with("output.txt")).count();
    let mut finished = 0;
    for round in 0..10 {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child_that_writes_until_killed"])
            .env("BIPLANE_TEST_STORE", study.store.dir())
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let patience = Instant::now();
        while study.store.size().unwrap().entries <= finished && patience.elapsed() < Duration::from_secs(30)
        {
            std::thread::sleep(Duration::from_micros(300));
        }
        std::thread::sleep(Duration::from_micros(370 * round));
        child.kill().unwrap();
        child.wait().unwrap();

        assert!(outputs() > finished, "the child finished nothing, or a finished entry was lost");
        finished = outputs();
        assert_eq!(files(&entries).len(), 2 * finished, "an entry has an output and a record");
        for n in 0..finished {
            let key = KeyParts::of::<Join>(&ParamsText::of(&params()).unwrap(), &long_inputs(n)).key();
            let value = study.store.get::<Text>(key).unwrap().unwrap().load().unwrap();
            assert!(value.0.len() > 100_000);
        }
    }
}

#[test]
fn runs_side_by_side_make_the_same_bytes_as_one_alone() {
    let alone = Study::new();
    let together = Study::new();
    let work = |store: &Store, order: &dyn Fn(u32) -> u32| {
        let text = ParamsText::of(&params()).unwrap();
        let context = Context::new();
        for n in (0..100).map(order) {
            let i = inputs(&n.to_string(), &["tail"]);
            let load = || Ok::<_, StoreError>(i.clone());
            let item = Item::of([n.to_string()]);
            let outcome =
                store.execute::<Join, _>("join", &item, &text, &i.hashes(), load, &context).unwrap();
            assert_eq!(*outcome.output.load().unwrap(), Text(format!("{n}, tail")));
        }
    };
    work(&alone.store, &|n| n);
    std::thread::scope(|scope| {
        for start in [0, 0, 50, 99] {
            let store = Store::open(together.store.dir()).unwrap();
            scope.spawn(move || work(&store, &|n| (n * 7 + start) % 100));
        }
    });
    let (a, b) = (files(alone.store.dir()), files(together.store.dir()));
    assert_eq!(a.len(), 201);
    assert_eq!(a, b);
}

#[test]
fn explain_says_why() {
    let study = Study::new();
    let (p, i) = (params(), inputs("a", &["b", "c"]));
    assert_eq!(study.explain("lunge/0017", &p, &i), "join/lunge/0017: never ran");
    let output = study.join("lunge/0017", &p, &i).output;
    let explain = |p: &JoinParams, i: &JoinInputs| study.explain("lunge/0017", p, i);
    assert_eq!(explain(&p, &i), "join/lunge/0017: cached");
    assert_eq!(explain(&p, &inputs("a", &["b", "d"])), "join/lunge/0017: input tail[1] changed");
    assert_eq!(explain(&p, &inputs("a", &["c", "b"])), "join/lunge/0017: input tail changed its order");
    assert_eq!(explain(&p, &inputs("a", &["b"])), "join/lunge/0017: input tail has 1 instead of 2");

    let mut other = params();
    other.limit.scale = 2.0;
    assert_eq!(explain(&other, &i), "join/lunge/0017: parameter limit.scale changed from 1.5 to 2");
    other.separator = "-".into();
    assert_eq!(
        explain(&other, &inputs("x", &["b", "c"])),
        "join/lunge/0017: parameter limit.scale changed from 1.5 to 2; \
         parameter separator changed from \", \" to \"-\"; input head changed"
    );

    let text = ParamsText::of(&p).unwrap();
    let item = Item::from("lunge/0017");
    let parts = KeyParts::of::<OtherCode>(&text, &i);
    let explanation = study.store.explain::<OtherCode>("join", &item, &parts).unwrap();
    assert_eq!(explanation.reasons, [Reason::Code]);
    assert_eq!(explanation.to_string(), "join/lunge/0017: the program's code changed");
    let parts = KeyParts::of::<OtherName>(&text, &i);
    let explanation = study.store.explain::<OtherName>("join", &item, &parts).unwrap();
    assert_eq!(explanation.to_string(), "join/lunge/0017: the step's stage changed from join to other");

    fs::write(output.path(), "").unwrap();
    assert_eq!(explain(&p, &i), "join/lunge/0017: entry damaged: output.txt has 0 bytes, 7 were written");
    study.store.discard(output.key()).unwrap();
    assert_eq!(explain(&p, &i), "join/lunge/0017: its entry was removed");
    assert_eq!(study.join("lunge/0017", &p, &i).how, How::Ran);
    let whole =
        study.store.explain::<Join>("other", &Item::whole(), &KeyParts::of::<Join>(&text, &i)).unwrap();
    assert!(whole.cached() && whole.to_string() == "other: cached");
}

#[test]
fn explain_names_parameters_that_came_went_or_moved_in_a_list() {
    let study = Study::new();
    let explain = |was: serde_json::Value, is: serde_json::Value| {
        let of = |v| ParamsText::of(v).unwrap();
        let load = || Ok::<_, StoreError>(());
        let (item, context) = (Item::whole(), Context::new());
        study.store.execute::<example::Any, _>("any", &item, &of(&was), &(), load, &context).unwrap();
        let parts = KeyParts::of::<example::Any>(&of(&is), &());
        study.store.explain::<example::Any>("any", &item, &parts).unwrap().to_string()
    };
    use serde_json::json;
    assert_eq!(explain(json!({"a": 1}), json!({"a": 1, "b": true})), "any: parameter b = true is new");
    assert_eq!(explain(json!({"a": {"c": 1}}), json!({"a": {}})), "any: parameter a.c is gone");
    assert_eq!(
        explain(json!({"a": [1, 2]}), json!({"a": [1, 3]})),
        "any: parameter a[1] changed from 2 to 3"
    );
    assert_eq!(explain(json!({"a": [1, {"b": 2}]}), json!({"a": [1]})), "any: parameter a[1] is gone");
}

#[test]
fn clean_removes_what_no_item_leads_to() {
    let study = Study::new();
    let latest = study.join("x", &params(), &inputs("first", &[])).output;
    let old_bytes: u64 = files(&study.store.dir().join("entries")).values().map(|b| b.len() as u64).sum();
    study.join("x", &params(), &inputs("second", &[]));
    study.join("y", &params(), &inputs("third", &[]));
    fs::create_dir(study.store.dir().join("entries/notes")).unwrap();
    assert_eq!(study.store.size().unwrap().entries, 3);

    for dry_run in [true, false] {
        let removed = study.store.clean(Clean::Unreferenced, dry_run).unwrap();
        assert_eq!((removed.entries, removed.bytes), (1, old_bytes));
    }
    assert!(study.store.get::<Text>(latest.key()).unwrap().is_none());
    assert_eq!(study.join("x", &params(), &inputs("second", &[])).how, How::Cached);
    assert_eq!(study.join("y", &params(), &inputs("third", &[])).how, How::Cached);
    assert_eq!(study.store.clean(Clean::Unreferenced, false).unwrap().entries, 0);

    assert_eq!(study.store.clean(Clean::Everything, true).unwrap().entries, 2);
    assert_eq!(study.store.clean(Clean::Everything, false).unwrap().entries, 2);
    assert_eq!(study.store.size().unwrap().entries, 0);
    assert_eq!(study.explain("x", &params(), &inputs("second", &[])), "join/x: never ran");
    assert!(study.store.dir().join("entries/notes").exists(), "what is not an entry is left alone");
}

#[test]
fn the_name_of_a_stage_is_that_of_its_step_only_by_chance() {
    assert_eq!((Join::NAME, Trim::NAME), ("join", "trim"));
    let study = Study::new();
    let text = ParamsText::of(&params()).unwrap();
    let i = inputs("a", &[]);
    let run = |step: &str| {
        let load = || Ok::<_, StoreError>(i.clone());
        study
            .store
            .execute::<Join, _>(step, &Item::whole(), &text, &i.hashes(), load, &Context::new())
            .unwrap()
            .how
    };
    assert_eq!(
        (run("one"), run("two")),
        (How::Ran, How::Cached),
        "two steps that do the same share the entry"
    );
}
