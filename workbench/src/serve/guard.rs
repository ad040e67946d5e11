//! Who may ask: requests that name this server, come from its own page and know its token.
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use rand::Rng;

/// Letters of a token: 32 of 62 are 190 bits.
const TOKEN_LENGTH: usize = 32;

/// Scripts and data come from this server only. Plotly sets styles, and makes pictures from blobs.
const POLICY: &str = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; \
     frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// A random name that nobody guesses.
pub fn random_token() -> String {
    let letters = rand::rng().sample_iter(rand::distr::Alphanumeric);
    letters.take(TOKEN_LENGTH).map(char::from).collect()
}

/// What a request has to say.
#[derive(Debug, Clone)]
pub struct Guard {
    token: String,
    hosts: [String; 2],
}

impl Guard {
    /// The guard of a server on a port.
    pub fn new(token: String, port: u16) -> Self {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        Self { token, hosts }
    }

    /// Why a request is refused; `None` if it is not.
    fn refusal(&self, path: &str, headers: &HeaderMap) -> Option<&'static str> {
        let text = |name| headers.get(name).map(HeaderValue::as_bytes);
        let is_own = |host: &[u8]| self.hosts.iter().any(|own| own.as_bytes() == host);
        let from_here = |origin: &[u8]| origin.strip_prefix(b"http://").is_some_and(is_own);
        if !text(header::HOST).is_some_and(is_own) {
            Some("the Host header names another server; open the address that hitch serve prints")
        } else if !text(header::ORIGIN).is_none_or(from_here) {
            Some("the request comes from another page; open the address that hitch serve prints")
        } else if path.split('/').nth(1) != Some(self.token.as_str()) {
            Some("the address lacks the right token; open the address that hitch serve prints")
        } else {
            None
        }
    }
}

/// Lets a request through or answers 403, and tells the browser what the page may load.
pub async fn check(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let mut response = match guard.refusal(request.uri().path(), request.headers()) {
        Some(reason) => (StatusCode::FORBIDDEN, reason).into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(path: &str, host: Option<&str>, origin: Option<&str>) -> bool {
        let guard = Guard::new("secret".to_owned(), 8080);
        let mut headers = HeaderMap::new();
        for (name, value) in [(header::HOST, host), (header::ORIGIN, origin)] {
            if let Some(value) = value {
                headers.insert(name, HeaderValue::from_str(value).unwrap());
            }
        }
        guard.refusal(path, &headers).is_some()
    }

    #[test]
    fn only_the_own_page_gets_through() {
        let own = Some("127.0.0.1:8080");
        assert!(!refused("/secret/", own, None));
        assert!(!refused("/secret/", Some("localhost:8080"), None));
        assert!(!refused("/secret/api", own, Some("http://127.0.0.1:8080")));
        assert!(refused("/secret/", None, None));
        assert!(refused("/secret/", Some("evil.example:8080"), None));
        assert!(refused("/secret/", Some("127.0.0.1:8081"), None));
        assert!(refused("/secret/", own, Some("http://evil.example")));
        assert!(refused("/secret/", own, Some("null")));
        assert!(refused("/", own, None));
        assert!(refused("/secre/", own, None));
        assert!(refused("/secret2/", own, None));
    }

    #[test]
    fn tokens_differ() {
        let [one, other] = [random_token(), random_token()];
        assert_eq!(one.len(), TOKEN_LENGTH);
        assert_ne!(one, other);
    }
}
