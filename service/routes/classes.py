"""Classes: which there are, and the models of each."""

from typing import Any

from fastapi import APIRouter

from models_store import catalog
from service.dependencies import CursorQuery, LimitQuery, ServicesDep
from service.routes import problems
from service.schemas.models import ClassOut, ClassPageOut, ModelOut

router = APIRouter(prefix="/v1/classes", tags=["models"])


@router.get("", response_model=ClassPageOut, responses=problems(422))
def list_classes(services: ServicesDep, limit: LimitQuery = 50, cursor: CursorQuery = None) -> Any:
    """List the classes by name, each with its models."""
    with services.database.reading() as session:
        page = catalog.list_classes(session, limit=limit, cursor=cursor)
    items = [ClassOut(name=name, models=[ModelOut.from_row(row) for row in rows]) for name, rows in page.items]
    return ClassPageOut(items=items, next_cursor=page.next_cursor)
