//! The page's files, embedded in the program.

use axum::body::Body;
use axum::http::{HeaderMap, Response, StatusCode, header};

#[derive(Debug)]
pub(super) struct Asset {
    /// Path of the file without the first `/`.
    pub(super) path: &'static str,
    mime: &'static str,
    tag: &'static str,
    bytes: &'static [u8],
    gzip: Option<&'static [u8]>,
}

/// Every file of the page's, by path.
pub(super) static ALL: &[Asset] = include!(concat!(env!("OUT_DIR"), "/assets.rs"));

/// Returns the file at a path; pages also by their short names.
pub(super) fn find(path: &str) -> Option<&'static Asset> {
    let path = match path.trim_start_matches('/') {
        "" => "index.html",
        "study" => "study.html",
        "results" => "results.html",
        "audience" => "audience.html",
        "history" => "history.html",
        "login" => "login.html",
        other => other,
    };
    ALL.binary_search_by(|asset| asset.path.cmp(path)).ok().map(|at| &ALL[at])
}

/// Returns whether a file is served without the token: the login page's files.
pub(super) fn is_open(path: &str) -> bool {
    let folders = ["/css/", "/js/", "/strings/"];
    path == "/login" || path == "/icon.svg" || folders.iter().any(|folder| path.starts_with(folder))
}

impl Asset {
    /// Returns the response to a request with these headers.
    pub(super) fn respond(&self, asked: &HeaderMap) -> Response<Body> {
        let said = |name| asked.get(name).and_then(|value| value.to_str().ok()).unwrap_or("");
        let mut response = Response::builder()
            .header(header::ETAG, self.tag)
            // The next load finds a new build; unchanged files are not sent again.
            .header(header::CACHE_CONTROL, "no-cache")
            .header(header::VARY, "accept-encoding");
        let known = said(header::IF_NONE_MATCH).split(',').any(|tag| tag.trim() == self.tag);
        if known {
            response = response.status(StatusCode::NOT_MODIFIED);
            return response.body(Body::empty()).unwrap_or_default();
        }
        response = response.header(header::CONTENT_TYPE, self.mime);
        let takes_gzip = said(header::ACCEPT_ENCODING).split(',').any(accepts_gzip);
        let body = match self.gzip.filter(|_| takes_gzip) {
            Some(gzip) => {
                response = response.header(header::CONTENT_ENCODING, "gzip");
                gzip
            }
            None => self.bytes,
        };
        response.body(Body::from(body)).unwrap_or_default()
    }
}

fn accepts_gzip(coding: &str) -> bool {
    let mut parts = coding.split(';').map(str::trim);
    parts.next() == Some("gzip") && parts.all(|part| !matches!(part, "q=0" | "q=0.0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assets_are_found_by_short_names_and_never_outside() {
        assert_eq!(find("/").map(|asset| asset.path), Some("index.html"));
        assert!(ALL.is_sorted_by_key(|asset| asset.path));
        for path in ["/../Cargo.toml", "/index.html/", "//etc/passwd", "/js"] {
            assert!(find(path).is_none(), "{path}");
        }
    }

    #[test]
    fn assets_are_not_sent_again_for_a_known_tag() {
        let index = find("/").unwrap();
        let mut asked = HeaderMap::new();
        let response = index.respond(&asked);
        assert_eq!(response.status(), StatusCode::OK);
        assert!(
            response.headers()[header::CONTENT_TYPE].to_str().unwrap().starts_with("text/html")
        );
        asked.insert(header::IF_NONE_MATCH, response.headers()[header::ETAG].clone());
        assert_eq!(index.respond(&asked).status(), StatusCode::NOT_MODIFIED);
    }

    #[test]
    fn assets_are_compressed_on_request() {
        assert!(accepts_gzip(" gzip") && accepts_gzip("gzip;q=0.5"));
        assert!(!accepts_gzip("br") && !accepts_gzip("gzip; q=0"));
    }
}
