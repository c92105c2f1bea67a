//! The pages in a real browser: `make test-browser` runs these where chromium is installed.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use crate::diagnose_twin::damped_twin;
use crate::report_kinds::{
    STRIPES, calibration_page, comparison_page, drawn_page, history_page, overturning_page,
};
use crate::report_pages::{run_page, sweep_page};

/// Chromium without a window, a profile or the network.
fn chromium(page: &Path, arguments: &[&str]) -> Output {
    let profile = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new("chromium");
    command.args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-sync"]);
    command.args(["--disable-background-networking", "--disable-component-update", "--disable-quic"]);
    command.args(["--enable-logging=stderr", "--virtual-time-budget=8000", "--proxy-server=127.0.0.1:9"]);
    command.arg(format!("--user-data-dir={}", profile.path().display())).args(arguments);
    command.arg(format!("file://{}", page.display())).output().expect("chromium starts")
}

/// Runs a script in the page; it fills `found`, which comes back with the errors that were met.
fn probe(page: &Path, width: u32, script: &str) -> Value {
    let watch = "<script>window.errors = []; addEventListener('error', (e) => errors.push(String(e.message)));</script>";
    let ask = format!(
        "<script>addEventListener('load', async () => {{ const found = {{}}; const wait = (ms) => new Promise((done) => setTimeout(done, ms));
        const all = (what) => [...document.querySelectorAll(what)];
        try {{ {script} }} catch (error) {{ errors.push(String(error)); }}
        found.errors = errors; found.fetched = performance.getEntriesByType('resource').filter((r) => !r.name.startsWith('data:')).length;
        found.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
        const told = document.createElement('pre'); told.id = 'probe'; told.textContent = JSON.stringify(found); document.body.append(told); }});</script>"
    );
    let html = fs::read_to_string(page).expect("the page");
    let html = html.replacen("<head>", &format!("<head>{watch}"), 1).replacen(
        "</body>",
        &format!("{ask}</body>"),
        1,
    );
    let probed = page.with_file_name("probed.html");
    fs::write(&probed, html).expect("written");
    let output = chromium(&probed, &["--dump-dom", &format!("--window-size={width},900")]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!said.contains("CONSOLE"), "the console is not silent: {said}");
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let told = dom.split_once("<pre id=\"probe\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let found: Value = serde_json::from_str(told.expect("the probe's answer").0).expect("JSON");
    assert_eq!(found["errors"], serde_json::json!([]));
    assert_eq!(found["fetched"], 0, "a page fetches nothing");
    // A phone is 400 px wide; what is wider scrolls within its own frame.
    assert_eq!(found["overflow"], 0, "the page is wider than its window of {width} px");
    found
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_sweep_page_in_chromium() {
    let (_folder, page) = sweep_page();
    for width in [1200, 500] {
        let found = probe(
            &page,
            width,
            "found.panels = all('.panel svg').filter((svg) => svg.getBoundingClientRect().height > 150).length;
             const circle = all('#records-lower .hits circle')[1];
             circle.dispatchEvent(new PointerEvent('pointerenter'));
             const tip = document.getElementById('tip');
             found.tip = tip.hidden ? '' : tip.textContent;
             circle.dispatchEvent(new PointerEvent('pointerleave'));
             found.gone = tip.hidden;
             const faded = () => all('#thickness .faded').length;
             found.before = faded();
             const key = document.querySelector('#thickness .legend button');
             key.click();
             found.chosen = faded();
             found.own = all('#thickness .faded').filter((e) => e.getAttribute('stroke') === key.dataset.colour).length;
             key.click();
             found.after = faded();",
        );
        assert_eq!(found["panels"], 9);
        let tip = found["tip"].as_str().expect("a text");
        assert!(tip.contains("pulse_1") && tip.contains("h/b 14"), "{tip}");
        assert_eq!(
            (&found["gone"], &found["before"], &found["after"], &found["own"]),
            (&true.into(), &0.into(), &0.into(), &0.into())
        );
        assert!(found["chosen"].as_u64().expect("a count") > 10, "{found}");
    }
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_run_page_in_chromium() {
    let (_folder, page, _) = run_page();
    let data = fs::read_to_string(&page).expect("the page");
    let data = data.split_once("motion-data\">").expect("data").1.split_once("</script>").expect("data").0;
    let data: Value = serde_json::from_str(data).expect("JSON");
    for width in [1200, 500] {
        let found = probe(
            &page,
            width,
            "const time = () => Number(document.querySelector('.scrub').value);
             const ink = () => { const from = document.querySelector('.stage canvas'); const c = document.createElement('canvas'); c.width = from.width; c.height = from.height; const g = c.getContext('2d', { willReadFrequently: true }); g.drawImage(from, 0, 0); const d = g.getImageData(0, 0, c.width, c.height).data; let sum = 0; for (let i = 3; i < d.length; i += 4) sum += d[i] > 0; return sum; };
             found.ink = ink();
             const scrub = document.querySelector('.scrub');
             scrub.value = 0.3; scrub.dispatchEvent(new Event('input'));
             found.time = time();
             found.values = document.querySelector('.state').lastChild.textContent;
             found.pattern = document.querySelector('.state b').textContent;
             document.querySelector('.next').click();
             found.impact = time();
             found.flash = ink();
             document.querySelector('.peak').click();
             found.peak = time();
             const magnify = document.querySelector('.magnify');
             magnify.value = 2; magnify.dispatchEvent(new Event('input'));
             found.magnified = magnify.nextSibling.textContent;
             scrub.value = 0; scrub.dispatchEvent(new Event('input'));
             document.querySelector('.play').click();
             await wait(1500);
             found.played = time();
             document.querySelector('.play').click();
             const stopped = time();
             await wait(300);
             found.paused = time() === stopped;
             found.cursor = all('svg line.cursor').length;
             const wide = document.querySelector('.panels.wide');
             const fades = () => wide.classList.contains('more');
             found.begins = fades();
             wide.scrollLeft = wide.scrollWidth; await wait(200);
             found.ends = fades();",
        );
        // What is cut at the edge of a phone fades there until its end is seen.
        assert_eq!((&found["begins"], &found["ends"]), (&(width < 700).into(), &false.into()), "{width} px");
        assert!(found["ink"].as_u64().expect("a count") > 2000, "a wall is drawn: {found}");
        assert_eq!(found["time"], 0.3);
        let theta1 = data["theta1"][60].as_f64().expect("a sample") / 1e6;
        let ratio = theta1 / data["alpha"][0].as_f64().expect("an angle");
        let told = format!("θ₁/α₁ = {ratio:.3}").replace('-', "−");
        assert!(found["values"].as_str().expect("a text").contains(&told), "{told} in {found}");
        let impacts = data["impacts"].as_array().expect("impacts");
        let next =
            impacts.iter().filter_map(|i| i[0].as_f64()).find(|t| *t > 0.3).expect("an impact after 0.3 s");
        // The slider stands on samples, 0.005 s apart.
        assert!((found["impact"].as_f64().expect("a time") - next).abs() <= 0.0026, "{next} in {found}");
        let peak = data["peaks"][0].as_f64().expect("a time");
        assert!((found["peak"].as_f64().expect("a time") - peak).abs() <= 0.0026);
        assert_eq!(found["magnified"], "× 100");
        // How many frames a headless browser draws in virtual time is its own affair, and the less the busier the machine: it
        // moves at all.
        assert!(found["played"].as_f64().expect("a time") > 0.0, "{found}");
        assert_eq!((&found["paused"], &found["cursor"]), (&true.into(), &1.into()));
    }
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_pages_print_in_chromium() {
    let (_folder, page) = sweep_page();
    let pdf = page.with_file_name("page.pdf");
    chromium(&page, &[&format!("--print-to-pdf={}", pdf.display())]);
    let bytes = fs::read(pdf).expect("a printed page");
    assert!(bytes.starts_with(b"%PDF") && bytes.len() > 20_000, "{} bytes", bytes.len());
}

/// What holds of every page with figures: they are drawn, values stand under the pointer, and the legend picks a curve.
fn figures_work(page: &Path) {
    for width in [1200, 500] {
        let found = probe(
            page,
            width,
            "const panels = all('.panel svg');
             found.panels = panels.length;
             found.drawn = panels.filter((svg) => svg.getBoundingClientRect().height > 60 && svg.querySelectorAll('text').length > 2).length;
             const circle = document.querySelector('.hits circle');
             circle.dispatchEvent(new PointerEvent('pointerenter'));
             const tip = document.getElementById('tip');
             found.tip = tip.hidden ? '' : tip.textContent;
             const figure = circle.closest('figure');
             const key = [...figure.querySelectorAll('.legend button')].find((key) => key.dataset.colour === circle.dataset.colour);
             key.click();
             found.faded = figure.querySelectorAll('.faded').length;
             found.own = [...figure.querySelectorAll('.faded')].filter((e) => e.getAttribute('stroke') === key.dataset.colour).length;
             key.click();
             found.after = figure.querySelectorAll('.faded').length;",
        );
        assert!(found["panels"].as_u64() > Some(0) && found["panels"] == found["drawn"], "{found}");
        assert!(found["tip"].as_str().is_some_and(|tip| tip.len() > 5), "{found}");
        assert!(found["faded"].as_u64() > Some(0), "{found}");
        assert_eq!((&found["own"], &found["after"]), (&0.into(), &0.into()));
    }
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_calibration_page_in_chromium() {
    let (_folder, page) = calibration_page();
    figures_work(&page);
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_diagnosis_page_in_chromium() {
    let (_folder, out, _) = damped_twin();
    figures_work(&out.join("report.html"));
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_comparison_page_in_chromium() {
    let (_folder, page) = comparison_page();
    figures_work(&page);
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_overturning_page_in_chromium() {
    let (_folder, page) = overturning_page();
    figures_work(&page);
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_history_page_in_chromium() {
    let (_folder, page) = history_page("parquet");
    figures_work(&page);
}

#[test]
#[ignore = "needs chromium: make test-browser"]
fn regress_drawn_page_in_chromium() {
    let (_folder, page) = drawn_page(STRIPES);
    figures_work(&page);
}
