//! Login with the token.

use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::{HeaderMap, Response, StatusCode, header};
use axum::response::{AppendHeaders, IntoResponse, Redirect};

use super::{Access, App};

/// Longest form, bytes.
const FORM_MAX: usize = 2_048;
/// Delay after a wrong token, against guessing.
const PAUSE: Duration = Duration::from_secs(1);

/// Sets the cookie for the right token.
pub(super) async fn login(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    form: Bytes,
) -> Response<Body> {
    if !Access::is_own(&headers) {
        return (StatusCode::FORBIDDEN, "log in from the console's own page\n").into_response();
    }
    let form = std::str::from_utf8(&form).ok().filter(|form| form.len() <= FORM_MAX);
    let token = form.and_then(|form| field(form, "token")).unwrap_or_default();
    match app.access.cookie_for(&token) {
        Some(cookie) => {
            (AppendHeaders([(header::SET_COOKIE, cookie)]), Redirect::to("/")).into_response()
        }
        None => {
            tokio::time::sleep(PAUSE).await;
            Redirect::to("/login?wrong").into_response()
        }
    }
}

/// Returns a field of a URL-encoded form.
fn field(form: &str, name: &str) -> Option<String> {
    let mut pairs = form.split('&').filter_map(|pair| pair.split_once('='));
    let (_, value) = pairs.find(|(key, _)| *key == name)?;
    let bytes = value.as_bytes();
    let (mut text, mut at) = (Vec::new(), 0);
    while let Some(&byte) = bytes.get(at) {
        let hex = bytes.get(at + 1..at + 3).filter(|_| byte == b'%');
        let hex = hex.and_then(|hex| u8::from_str_radix(std::str::from_utf8(hex).ok()?, 16).ok());
        text.push(hex.unwrap_or(if byte == b'+' { b' ' } else { byte }));
        at += if hex.is_some() { 3 } else { 1 };
    }
    String::from_utf8(text).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn login_reads_a_url_encoded_form() {
        let form = "a=b&token=p%26a+b%25%C3%A9%zz";
        assert_eq!(field(form, "token").as_deref(), Some("p&a b%é%zz"));
        assert_eq!(field("token=%ff", "token"), None);
        assert_eq!(field("", "token"), None);
    }
}
