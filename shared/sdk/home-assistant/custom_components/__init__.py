"""Integrations of this folder, for tests."""
