"""Signing in with an OpenID Connect provider: what is asked of it, and how what it says is checked."""
