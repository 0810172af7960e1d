"""Estimations say their model, keep their residuals and a time limit, and a query its unit and its up axis

Revision ID: 20261126_estimations
Revises: 20261125_parts
Create Date: 2026-11-26 21:00:00
"""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "20261126_estimations"
down_revision = "20261125_parts"
branch_labels = None
depends_on = None

_ESTIMATIONS = sa.table(
    "estimations",
    sa.column("id", sa.String),
    sa.column("model_id", sa.String),
    sa.column("result", sa.JSON(none_as_null=True)),
)
_MODELS = sa.table("models", sa.column("id", sa.String), sa.column("name", sa.Text))


def upgrade() -> None:
    op.add_column("estimations", sa.Column("units", sa.String(2), nullable=True))
    op.add_column("estimations", sa.Column("up", sa.String(2), nullable=True))
    op.add_column("estimations", sa.Column("time_limit_s", sa.Double(), nullable=True))
    op.add_column("estimations", sa.Column("residuals_key", sa.Text(), nullable=True))
    _rewrite(_with_model)


def downgrade() -> None:
    _rewrite(_with_models_tried)
    op.drop_column("estimations", "residuals_key")
    op.drop_column("estimations", "time_limit_s")
    op.drop_column("estimations", "up")
    op.drop_column("estimations", "units")


def _rewrite(change: Any) -> None:
    connection = op.get_bind()
    names = {row.id: row.name for row in connection.execute(sa.select(_MODELS))}
    for row in connection.execute(sa.select(_ESTIMATIONS).where(_ESTIMATIONS.c.result.is_not(None))).all():
        model = {"id": row.model_id, "name": names.get(row.model_id, "")}
        changed = change(dict(row.result), model)
        connection.execute(_ESTIMATIONS.update().where(_ESTIMATIONS.c.id == row.id).values(result=changed))


def _with_model(result: dict[str, Any], model: dict[str, str]) -> dict[str, Any]:
    tried = [
        {
            "model": {"id": one["model_id"], "name": one["model_name"]},
            "distances": one["distances"],
            "panorama": one["panorama"],
        }
        for one in result.pop("models_tried", [])
    ]
    return {"estimator": "reference", "model": model, **result, "tried": tried}


def _with_models_tried(result: dict[str, Any], model: dict[str, str]) -> dict[str, Any]:
    known = [one for one in result.pop("tried", []) if one["panorama"] is not None]
    tried = [
        {
            "model_id": one["model"]["id"],
            "model_name": one["model"]["name"],
            "panorama": one["panorama"],
            "distances": one["distances"],
        }
        for one in known
    ]
    return {**result, "models_tried": tried if len(tried) > 1 else []}
