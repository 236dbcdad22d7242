"""Who plays which part in a conversation, and what is to be told to whom."""

from waggle_tasks import conversation
from waggle_tasks.agents import caller, contender, listener, part, relay
from waggle_tasks.experiments.record import talk
from waggle_tasks.protocol import letters


def told(scene: conversation.Conversation) -> tuple[talk.Told, ...]:
  """What is to be told to whom."""
  if scene.mission == 'relay':
    return (talk.Told(0, scene.hops, scene.payload),)
  if scene.mission == 'ack':
    said = scene.bits or scene.payload
    audience = range(1, scene.listeners + 1)
    return tuple(talk.Told(0, each, said) for each in audience)
  return tuple(
    talk.Told(dancer, recipient, bits)
    for dancer in range(scene.dancers)
    for recipient, bits in scene.letters_of(dancer)
  )


def cast(scene: conversation.Conversation) -> list[part.Part]:
  """What each member does, by number."""
  accord, numbers = scene.accord, range(len(scene.poses()))
  if scene.mission == 'relay':
    first = letters.Letter(scene.payload, recipient=scene.hops)
    return [relay.Relay(accord, k, None if k else first) for k in numbers]
  if scene.mission == 'ack':
    said = scene.bits or scene.payload
    speaker = caller.Caller(accord, 0, said, scene.blind, scene.seed)
    readers = [listener.Listener(accord, k, scene.blind) for k in numbers[1:]]
    return [speaker, *readers]
  dancers = [
    contender.Contender(
      accord, k, scene.letters_of(k), scene.seed, not scene.together
    )
    for k in numbers[: scene.dancers]
  ]
  audience = [
    listener.Listener(accord, k, flies=False) for k in numbers[scene.dancers :]
  ]
  return [*dancers, *audience]
