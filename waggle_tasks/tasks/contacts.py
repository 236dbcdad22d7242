"""Which vehicles touch one another, or the room."""

from dm_control import mjcf


def find(physics: mjcf.Physics) -> set[tuple[str, str]]:
  """Pairs of names that touch now; 'room' is the arena."""
  model, pairs = physics.model, set[tuple[str, str]]()
  for contact in physics.data.contact[: physics.data.ncon]:
    names = [  # Of what stands in the room, the room's.
      model.id2name(model.body_weldid[model.geom_bodyid[geom]], 'body').split(
        '/'
      )[0]
      for geom in (contact.geom1, contact.geom2)
    ]
    one, other = ('room' if name == 'world' else name for name in names)
    pairs.add((min(one, other), max(one, other)))
  return pairs
