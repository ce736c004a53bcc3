//! Logins: by a form, or by a link that carries the secret.

use std::time::Duration;

use axum::extract::DefaultBodyLimit;
use axum::http::Uri;

/// Longest form with a secret, bytes.
const FORM_MAX: usize = 2_048;
/// Delay after a wrong secret, against guessing.
const PAUSE: Duration = Duration::from_secs(1);

/// Waits before the answer to a wrong secret.
pub async fn pause() {
    tokio::time::sleep(PAUSE).await;
}

/// Returns the secret of a login's form; an empty one where it has none.
pub fn secret_of(form: &[u8]) -> String {
    let form = std::str::from_utf8(form).ok().filter(|form| form.len() <= FORM_MAX);
    form.and_then(|form| form_field(form, "token")).unwrap_or_default()
}

/// The limit of what is read of a login.
pub fn form_limit() -> DefaultBodyLimit {
    DefaultBodyLimit::max(FORM_MAX)
}

/// Returns a page that leads to another one of this server. A redirect of another site's link would not carry a new cookie;
/// the page's own step does. `icon` is the address of the icon, for which a browser would guess one otherwise.
pub fn stepping_stone(page: &str, icon: &str) -> String {
    let page = page.replace('&', "&amp;").replace('"', "&quot;");
    format!(
        "<!doctype html><link rel=\"icon\" href=\"{icon}\"><meta http-equiv=\"refresh\" content=\"0;url={page}\">\
         <title>whichone</title><p>whichone\n"
    )
}

/// Returns the secret of a link, and the link's page without it: the secret does not stay in the address.
pub fn token_of(uri: &Uri) -> Option<(String, String)> {
    let query = uri.query()?;
    let token = form_field(query, "token")?;
    let rest: Vec<&str> = query.split('&').filter(|pair| !pair.starts_with("token=")).collect();
    // One slash: two would lead to another host.
    let path = format!("/{}", uri.path().trim_start_matches('/'));
    let mark = if rest.is_empty() { "" } else { "?" };
    Some((token, format!("{path}{mark}{}", rest.join("&"))))
}

/// Returns a field of a form or a query.
pub fn form_field(form: &str, name: &str) -> Option<String> {
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
    fn link_leads_to_its_page_without_the_token() {
        let split = |link: &str| token_of(&link.parse().unwrap());
        let of = |token: &str, page: &str| Some((token.to_owned(), page.to_owned()));
        assert_eq!(split("/?token=abc"), of("abc", "/"));
        assert_eq!(
            split("/study?lang=de&token=a%2Db&role=screen"),
            of("a-b", "/study?lang=de&role=screen")
        );
        assert_eq!(split("//evil.example/?token=abc"), of("abc", "/evil.example/"));
        assert_eq!(split("/?tokens=abc"), None);
        assert_eq!(split("/"), None);
    }

    #[test]
    fn login_reads_a_url_encoded_form() {
        let form = "a=b&token=p%26a+b%25%C3%A9%zz";
        assert_eq!(form_field(form, "token").as_deref(), Some("p&a b%é%zz"));
        assert_eq!(form_field("token=%ff", "token"), None);
        assert_eq!(form_field("", "token"), None);
    }
}
