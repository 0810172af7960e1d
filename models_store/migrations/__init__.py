"""Revisions of the database; :func:`models_store.session.upgrade` applies them."""
