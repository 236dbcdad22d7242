"""Which vehicles touch one another, or the room."""

from dm_control import mjcf


def find(physics: mjcf.Physics) -> tuple[tuple[str, str], ...]:
  """Pairs of names that touch now; 'room' is the arena."""
  if not physics.data.ncon:
    return ()
  model, pairs = physics.model, set()
  for contact in physics.data.contact[: physics.data.ncon]:
    names = [
      model.id2name(model.geom_bodyid[geom], 'body').split('/')[0]
      for geom in (contact.geom1, contact.geom2)
    ]
    named = ('room' if name == 'world' else name for name in names)
    pairs.add(tuple(sorted(named)))
  return tuple(sorted(pairs))
